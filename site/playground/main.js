// The playground: a scenario, and beside it its answer, figures, margins, noise and model, from the engine in this page.

import { answerHtml, escaped } from "./answer.js";
import { Editor } from "./editor.js";
import { Engine, Stopped, Trapped } from "./engine.js";
import { unpackedScript } from "./packed.js";
import { Schema } from "./schema.js";
import { packed, sha256, unpacked } from "./share.js";
import { Sliders } from "./sliders.js";

// A run is repeated while a slider moves up to the first time (s), and by itself up to the second; above the third the page asks.
const [QUICK, AUTOMATIC, LONG] = [0.2, 5, 60];
const PAUSE = 350;
// Time of a run here over that of the command.
const SLOWER = 2;
const FIRST = "earth-observer";

const place = (name) => document.querySelector(`#playground [data-place="${name}"]`);

// A line in place of what cannot be drawn.
function refusal(what, error) {
  if (error instanceof Stopped || error instanceof Trapped) throw error;
  return `<p class="refused">${escaped(what)}: ${escaped(error.message)}</p>`;
}

class Playground {
  constructor() {
    this.engine = new Engine();
    this.engine.onprogress = (part) => this.progress(part);
    this.editor = new Editor(place("editor"), {
      onchange: () => this.changed(),
      oncursor: () => this.sliders.setCurrent(this.editor.number()),
      onrun: () => this.run(true),
    });
    this.sliders = new Sliders(place("sliders"), this.editor, () => this.changed(0));
    this.estimate = 0;
    this.tab = "time";
    this.times = [null, null];
    this.generation = 0;
    // A phone shows the answer first; its text opens at a touch.
    place("text").open = innerWidth > 960;
    this.listen();
  }

  async open() {
    this.say("loading the engine");
    this.examples = new Map(await this.engine.json({ ask: "examples" }));
    this.editor.schema = new Schema(await this.engine.json({ ask: "schema" }));
    this.style = (await this.engine.text({ ask: "style" })).replace(":root", ":host");
    const select = place("scenario");
    const shown = Object.keys(globalThis.FLEXSC_GALLERY ?? {});
    const all = [...shown, ...[...this.examples.keys()].filter((name) => !shown.includes(name))];
    select.replaceChildren(...all.map((name) => new Option(globalThis.FLEXSC_GALLERY?.[name] ? `${name}: ${globalThis.FLEXSC_GALLERY[name].title}` : name, name)));
    const asked = await unpacked(location.hash).catch(() => ({ name: "" }));
    const name = this.examples.has(asked.name) || asked.text ? asked.name : FIRST;
    this.load(name, asked.text ?? this.examples.get(name));
  }

  listen() {
    place("scenario").onchange = ({ target }) => {
      history.replaceState(null, "", `#${target.value}`);
      this.load(target.value, this.examples.get(target.value));
    };
    addEventListener("hashchange", async () => {
      const { name, text } = await unpacked(location.hash);
      if (text || this.examples?.has(name)) this.load(name, text ?? this.examples.get(name));
    });
    place("run").onclick = () => this.run(true);
    place("stop").onclick = () => this.stop();
    addEventListener("keydown", (event) => {
      if (event.key === "Escape" && this.isRunning) this.stop();
    });
    place("share").onclick = async () => {
      history.replaceState(null, "", `#${await packed(this.name, this.editor.text)}`);
      this.say("the address of this page now has the scenario");
    };
    place("download").onchange = ({ target }) => {
      this.download(target.value).catch((error) => this.say(error.message, true));
      target.value = "";
    };
    for (const button of document.querySelectorAll("#playground [data-tab]")) {
      button.onclick = () => this.choose(button.dataset.tab);
    }
    document.querySelector("#playground").addEventListener("click", ({ target }) => {
      if (target.matches(".instant")) this.zoom(Number(target.dataset.from), Number(target.dataset.to));
      if (target.matches("[data-line]")) {
        place("text").open = true;
        this.editor.show(Number(target.dataset.line));
      }
    });
    for (const name of ["from", "to"]) {
      place(name).onchange = () => {
        this.times = ["from", "to"].map((own) => (place(own).value === "" ? null : Number(place(own).value)));
        this.draw();
      };
    }
  }

  load(name, text) {
    this.name = name.replace(/\.toml$/, "");
    place("scenario").value = this.name;
    this.times = [null, null];
    place("from").value = place("to").value = "";
    this.isLoading = true;
    this.editor.text = text;
    this.isLoading = false;
    this.changed(0);
  }

  get file() {
    return `${this.name}.toml`;
  }

  changed(pause = this.sliders?.isMoving && this.estimate < QUICK ? 0 : PAUSE) {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.check(), this.isLoading ? 0 : pause);
  }

  // Checks the text; what is in progress is of an earlier one.
  async check() {
    const generation = (this.generation += 1);
    if (this.engine.isBusy) this.engine.restart();
    try {
      const checked = await this.engine.json({ ask: "check", file: this.file, text: this.editor.text });
      if (generation !== this.generation) return;
      this.accepted = checked.accepted;
      const mistakes = checked.mistakes ?? [];
      this.editor.mark(mistakes);
      place("errors").innerHTML = mistakes
        .map((own) => `<li><button data-line="${own.line ?? 1}">line ${own.line ?? "?"}</button> ${escaped(own.message)}</li>`)
        .join("");
      const lines = this.editor.text.split("\n").length;
      place("lines").textContent = `${this.name}.toml, ${lines} lines, ${mistakes.length} ${mistakes.length === 1 ? "error" : "errors"}`;
      place("result").classList.toggle("old", !checked.accepted);
      if (!checked.accepted) {
        this.say(`${mistakes.length} ${mistakes.length === 1 ? "error" : "errors"} in the text: what is shown is of the last accepted one`);
        return;
      }
      this.estimate = checked.estimate_s * SLOWER;
      if (!this.sliders.isMoving) this.sliders.setUncertain(checked.uncertain);
      if (this.estimate <= (this.sliders.isMoving ? QUICK : AUTOMATIC)) await this.run(false);
      else this.say(`accepted; a run takes about ${Math.ceil(this.estimate)} s here`);
    } catch (error) {
      this.failed(error);
    }
  }

  async run(isAsked) {
    if (!this.accepted) return;
    if (this.estimate > LONG && isAsked && !confirm(`The run takes about ${Math.ceil(this.estimate)} s here. Run it?`)) return;
    const { generation } = this;
    this.running(true);
    const began = performance.now();
    try {
      const result = await this.engine.json({ ask: "run" });
      const took = (performance.now() - began) / 1000;
      this.result = result;
      place("answer").innerHTML = answerHtml(result);
      this.say(`run of ${this.file} in ${took.toPrecision(2)} s`);
      this.running(false);
      await this.fingerprint(generation);
      await this.draw();
    } catch (error) {
      this.failed(error);
    } finally {
      this.running(false);
    }
  }

  running(isRunning) {
    this.isRunning = isRunning;
    place("stop").hidden = !isRunning;
    place("run").disabled = isRunning;
    place("bar").hidden = !isRunning;
    place("bar").removeAttribute("value");
  }

  progress(part) {
    place("bar").value = part;
  }

  stop() {
    this.engine.restart();
    this.running(false);
    this.say("stopped");
    // The new engine has not read the text.
    this.accepted = false;
    this.reread();
  }

  async reread() {
    const checked = await this.engine.json({ ask: "check", file: this.file, text: this.editor.text });
    this.accepted = checked.accepted;
  }

  failed(error) {
    if (error instanceof Stopped) return;
    if (error instanceof Trapped) {
      this.reread();
      this.say(`the engine stopped (${error.message}) and has been started again; change the scenario, or run it once more`, true);
    } else {
      place("answer").innerHTML = `<p class="verdict red">FAILED</p><pre>${escaped(error.message)}</pre>`;
      this.say("the run failed", true);
    }
  }

  say(text, isBad = false) {
    place("status").textContent = text;
    place("status").classList.toggle("bad", isBad);
  }

  // The hash of the log, beside that of the native command where the site knows it.
  async fingerprint(generation) {
    const bytes = await this.engine.bytes({ ask: "log" });
    if (generation !== this.generation) return;
    const own = await sha256(bytes);
    this.hash = own;
    const native = this.examples.get(this.name) === this.editor.text ? globalThis.FLEXSC_GALLERY?.[this.name]?.sha256 : undefined;
    const size = bytes.length < 1e6 ? `${Math.ceil(bytes.length / 1e3)} kB` : `${(bytes.length / 1e6).toFixed(1)} MB`;
    const known = native === undefined ? "" : native === own ? " = that of the native command" : " differs from that of the native command";
    place("hash").innerHTML = own
      ? `log ${size}, SHA-256 <code title="${own}">${own.slice(0, 16)}…</code>${known}`
      : `log ${size}; this browser computes SHA-256 only on secure pages`;
    place("hash").dataset.sha256 = own ?? "";
    place("command").textContent = `flexsc simulate ${this.file} && sha256sum ${this.name}.mcap`;
  }

  choose(tab) {
    this.tab = tab;
    for (const button of document.querySelectorAll("#playground [data-tab]")) {
      button.setAttribute("aria-selected", String(button.dataset.tab === tab));
    }
    place("times").hidden = tab !== "time";
    this.draw();
  }

  zoom(from, to) {
    // An instant gets some room around it.
    const room = Math.max(0.02 * this.result.answer.duration_s, 0.5 * (to - from));
    this.times = [Math.max(0, from - room), Math.min(this.result.answer.duration_s, to + room)];
    [place("from").value, place("to").value] = this.times.map((time) => Number(time.toPrecision(5)));
    this.choose("time");
  }

  // Draws the chosen tab of the last run.
  async draw() {
    if (!this.result || this.isRunning) return;
    this.remove?.();
    this.remove = null;
    const figures = place("figures");
    const { tab, generation } = this;
    const isCurrent = () => tab === this.tab && generation === this.generation;
    try {
      if (tab === "time") {
        const drawn = [];
        for (const name of this.result.figures) {
          const svg = this.engine.text({ ask: "figure", name, from: this.times[0], to: this.times[1] });
          const html = await svg.then((own) => `<figure aria-label="${escaped(name)}">${own}</figure>`).catch((error) => refusal(name, error));
          if (!isCurrent()) return;
          drawn.push(html);
          figures.innerHTML = drawn.join("");
        }
        return;
      }
      const ask = { frequency: "margins", noise: "noise", craft: "spacecraft" }[tab];
      const html = await this.engine.text({ ask }).catch((error) => refusal(ask, error));
      if (!isCurrent()) return;
      const block = document.createElement("div");
      block.attachShadow({ mode: "open" }).innerHTML = `<style>${this.style}</style><div class="page">${html}</div>`;
      figures.replaceChildren(block);
      if (tab === "craft") await this.model(figures, isCurrent);
    } catch (error) {
      this.failed(error);
    }
  }

  async model(figures, isCurrent) {
    const view = document.createElement("div");
    view.className = "model";
    figures.prepend(view);
    const button = document.createElement("button");
    button.textContent = "Show it turning";
    view.append(button);
    const start = async () => {
      button.disabled = true;
      if (!globalThis.FLEXSC_MODEL) await unpackedScript("model.js");
      const bytes = await this.engine.bytes({ ask: "model" });
      if (isCurrent()) this.remove = await globalThis.FLEXSC_MODEL.show(view, bytes);
    };
    const shown = () => start().catch((error) => (view.innerHTML = refusal("model", error))).catch((error) => this.failed(error));
    button.onclick = shown;
    if (this.estimate < 1) await shown();
  }

  async download(what) {
    const { name } = this;
    const bytes = {
      scenario: async () => [this.editor.text, `${name}.toml`],
      log: async () => [await this.engine.bytes({ ask: "log" }), `${name}.mcap`],
      answer: async () => [JSON.stringify(this.result.answer, null, 1), `${name}.json`],
      figures: async () => [place("figures").innerHTML, `${name}-figures.html`],
      model: async () => [await this.engine.bytes({ ask: "model" }), `${name}.glb`],
    }[what];
    if (!bytes || !this.result) return;
    const [data, file] = await bytes();
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([data]));
    link.download = file;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }
}

if (typeof WebAssembly === "undefined" || typeof DecompressionStream === "undefined") {
  place("status").textContent = "this browser has no WebAssembly or no DecompressionStream: Chrome 80, Firefox 113 and Safari 16.4 have both";
} else {
  globalThis.playground = new Playground();
  globalThis.playground
    .open()
    .catch((error) => {
      place("status").textContent = `the engine cannot be loaded: ${error.message}`;
    });
}
