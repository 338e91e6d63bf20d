// Runs the engine beside the page, so that the page stays alive.

let engine;
let words = "";

function imports(module) {
  const failed = (address, length) => {
    words = new TextDecoder().decode(new Uint8Array(engine.memory.buffer, address, length));
  };
  const known = { progress: (part) => postMessage({ progress: part }), failed };
  const all = {};
  for (const { module: from, name, kind } of WebAssembly.Module.imports(module)) {
    const absent = () => {
      throw new Error(`${from}.${name} is not there in a browser`);
    };
    all[from] ??= {};
    if (kind === "function") all[from][name] = from === "flexsc" ? known[name] : absent;
  }
  return all;
}

function answered(request) {
  const text = new TextEncoder().encode(JSON.stringify(request));
  const place = engine.flexsc_allocate(text.length);
  new Uint8Array(engine.memory.buffer, place, text.length).set(text);
  const length = engine.flexsc_answer(place, text.length);
  return new Uint8Array(engine.memory.buffer, engine.flexsc_result(), length).slice();
}

self.onmessage = ({ data }) => {
  try {
    if (data.module) {
      engine = new WebAssembly.Instance(data.module, imports(data.module)).exports;
      return;
    }
    const bytes = answered(data.request);
    postMessage({ id: data.id, bytes }, [bytes.buffer]);
  } catch (trap) {
    postMessage({ id: data.id, trap: words || String(trap.message ?? trap) });
  }
};
