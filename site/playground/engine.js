// The engine in a worker: requests and results, stops, and a new start after a trap.

import source from "worker:./worker.js";
import { unpackedFile } from "./packed.js";

export class Stopped extends Error {}
export class Trapped extends Error {}

// The reason of a request that failed, in the words of the engine.
function failure(bytes) {
  const decoder = new TextDecoder();
  return decoder.decode(bytes.subarray(0, 9)) === '{"error":' ? JSON.parse(decoder.decode(bytes)).error : null;
}

export class Engine {
  constructor() {
    this.waiting = new Map();
    this.count = 0;
    this.onprogress = () => {};
    this.module = unpackedFile("engine.wasm").then((bytes) => WebAssembly.compile(bytes));
    this.start();
  }

  start() {
    const address = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
    const worker = new Worker(address);
    this.worker = worker;
    worker.onmessage = ({ data }) => {
      if (worker !== this.worker) return;
      if (data.progress !== undefined) this.onprogress(data.progress);
      else this.settle(data);
    };
    worker.onerror = (event) => this.restart(new Trapped(event.message));
    this.ready = this.module.then((module) => worker.postMessage({ module }));
  }

  settle({ id, bytes, trap }) {
    const asked = this.waiting.get(id);
    this.waiting.delete(id);
    if (trap !== undefined) {
      asked?.reject(new Trapped(trap));
      this.restart(new Trapped(trap));
    } else {
      const why = failure(bytes);
      if (why === null) asked?.resolve(bytes);
      else asked?.reject(new Error(why));
    }
  }

  // Ends what runs: WebAssembly has no other way to stop.
  restart(reason = new Stopped("stopped")) {
    this.worker.terminate();
    for (const asked of this.waiting.values()) asked.reject(reason);
    this.waiting.clear();
    this.start();
  }

  // True if something runs that takes long.
  get isBusy() {
    return [...this.waiting.values()].some(({ ask }) => !["check", "log", "examples", "schema", "style"].includes(ask));
  }

  async bytes(request) {
    await this.ready;
    const id = (this.count += 1);
    const asked = new Promise((resolve, reject) => this.waiting.set(id, { ask: request.ask, resolve, reject }));
    this.worker.postMessage({ id, request });
    return asked;
  }

  async text(request) {
    return new TextDecoder().decode(await this.bytes(request));
  }

  async json(request) {
    return JSON.parse(await this.text(request));
  }
}
