// The built site in a real Chromium: `node tests/site_browser.mjs`, after `python3 site/build.py --playground`.
//
// The playground checks, edits, runs and draws; its logs have the bytes of the command's; the search finds what readers type; no page is
// wider than the screen. `python3 tests/site_browser.py` prints what is missing where it cannot run.

import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, mkdtempSync, readFileSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, normalize } from "node:path";
import { fileURLToPath } from "node:url";

const ROOT = fileURLToPath(new URL("..", import.meta.url));
const SITE = join(ROOT, "target/site");
const [browserPath, command] = process.argv.slice(2);
const { chromium } = createRequire(join(ROOT, "target/playground-packages/"))("playwright-core");

// Scenarios whose logs are compared: one axis and three, relays, filters, orbits, jets, gyros, hinges.
const COMPARED = [
  "relay-fixed", "relay-adaptive", "wheel-ekf", "slew-wheel-lqg", "rotation-robust",
  "earth-observer", "half-turn", "iss-ringdown", "agile-observer", "panel-deployment",
];
// What is typed into the search, and the page that is to be the first.
const QUERIES = {
  STM32: "flight-code", waterfall: "noise", percentile: "campaigns", ROS: "serve", RAAN: "scenario/environment", LTAN: "scenario/environment",
  "wheel saturation": "read-metrics", "compare two runs": "other-programs", "panel mass size": "data-sheets", cubesat: "tutorials/cubesat",
  "own law": "own-parts", Nichols: "linear-models", Nastran: "import", Simulink: "fmi", gym: "stepping", install: "install",
  "design review": "figures", limitations: "validity", "star tracker": "scenario/sensors", "safe mode": "scenario/modes",
};
const LONGEST_ANSWER = 20_000;
const MOST_BYTES = 4_000_000;
const TYPES = { html: "text/html", js: "text/javascript", css: "text/css", svg: "image/svg+xml", json: "application/json", png: "image/png" };

function assert(holds, why) {
  if (!holds) throw new Error(why);
}

const server = createServer((request, response) => {
  const path = normalize(join(SITE, decodeURIComponent(new URL(request.url, "http://x").pathname)));
  if (!path.startsWith(SITE) || !existsSync(path) || !statSync(path).isFile()) {
    response.writeHead(404).end();
    return;
  }
  response.writeHead(200, { "content-type": TYPES[path.split(".").at(-1)] ?? "application/octet-stream" }).end(readFileSync(path));
}).listen(0, "127.0.0.1");
await new Promise((done) => server.once("listening", done));
const base = `http://127.0.0.1:${server.address().port}`;
const browser = await chromium.launch({ executablePath: browserPath, args: ["--no-sandbox", "--enable-unsafe-swiftshader"] });
const passed = [];

async function test(name, work) {
  try {
    const told = await work();
    passed.push(name);
    console.log(`ok: ${name}${told ? `: ${told}` : ""}`);
  } catch (error) {
    console.error(`FAILED: ${name}\n${error.stack}`);
    process.exitCode = 1;
  }
}

async function opened(width, address) {
  const page = await browser.newPage({ viewport: { width, height: 900 } });
  page.on("pageerror", (error) => {
    console.error(`FAILED: a script of ${address}: ${error.message}`);
    process.exitCode = 1;
  });
  await page.goto(address);
  return page;
}

const ready = (page) => page.waitForFunction(() => document.querySelector('[data-place="hash"]').dataset.sha256, null, { timeout: 120_000 });
const verdict = (page) => page.textContent("#playground .verdict");
const isNarrow = (page) => page.evaluate(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth);

const page = await browser.newPage({ viewport: { width: 1400, height: 900 } });
let bytes = 0;
page.on("response", async (response) => {
  bytes += Number((await response.allHeaders())["content-length"] ?? (await response.body().catch(() => [])).length);
});
await test("the first answer comes soon, and little is transferred", async () => {
  const began = performance.now();
  await page.goto(`${base}/playground.html#earth-observer`);
  await page.waitForSelector("#playground .verdict", { timeout: LONGEST_ANSWER });
  const took = performance.now() - began;
  assert((await verdict(page)).includes("goal met"), await verdict(page));
  await ready(page);
  assert(bytes > 1_000_000 && bytes < MOST_BYTES, `${bytes} bytes`);
  return `${(took / 1000).toFixed(1)} s, ${(bytes / 1e6).toFixed(2)} MB`;
});

await test("a mistake is shown at its line, and its suggestion mends it", async () => {
  await page.evaluate(() => {
    const { editor } = globalThis.playground;
    const place = editor.text.indexOf("bandwidth");
    editor.replace(place, place + 9, "bandwith");
  });
  await page.waitForSelector("#playground .errors li");
  const error = await page.textContent("#playground .errors li");
  const line = readFileSync(join(ROOT, "scenarios/earth-observer.toml"), "utf8").split("\n").findIndex((own) => own.startsWith("bandwidth")) + 1;
  assert(error.includes(`line ${line}`) && error.includes("did you mean `bandwidth`"), error);
  assert((await page.$$("#playground .old")).length === 1, "the last answer is not grey");
  await page.click("#playground .errors button");
  await page.hover(".cm-lintRange-error");
  await page.click('.cm-diagnosticAction');
  await page.waitForFunction(() => document.querySelectorAll("#playground .errors li").length === 0);
  assert((await page.evaluate(() => globalThis.playground.editor.text)) === readFileSync(join(ROOT, "scenarios/earth-observer.toml"), "utf8"), "the text is not mended");
});

await test("completion has the keys of the place", async () => {
  const found = await page.evaluate(() => {
    const { editor } = globalThis.playground;
    const place = editor.text.indexOf("[law.attitude]") + "[law.attitude]".length;
    const text = `${editor.text.slice(0, place)}\nda`;
    const doc = { toString: () => text };
    return editor.complete({ state: { doc }, pos: text.length, explicit: true }).options.map((own) => own.label);
  });
  assert(found.includes("damping") && found.includes("bandwidth") && !found.includes("mass"), found.join());
});

await test("a slider writes its number into the text, and the answer follows", async () => {
  const before = await page.getAttribute('[data-place="hash"]', "data-sha256");
  await page.evaluate(() => {
    const { editor } = globalThis.playground;
    editor.show(editor.text.slice(0, editor.text.indexOf("bandwidth =")).split("\n").length);
    const anchor = editor.text.indexOf("bandwidth =") + "bandwidth = ".length + 1;
    editor.view.dispatch({ selection: { anchor } });
  });
  await page.waitForSelector("#playground .sliders input");
  await page.$eval("#playground .sliders input", (input) => {
    input.value = input.max;
    input.dispatchEvent(new Event("input"));
    input.dispatchEvent(new Event("change"));
  });
  await page.waitForFunction((old) => ![old, ""].includes(document.querySelector('[data-place="hash"]').dataset.sha256), before);
  assert((await page.evaluate(() => globalThis.playground.editor.text)).includes("bandwidth = 0.2 "), "the text has another number");
});

await test("figures, margins, noise and the model are drawn", async () => {
  await page.waitForSelector("#playground .figures svg");
  for (const [tab, words] of [["frequency", "Crossover"], ["noise", "Rms"], ["craft", "kg m²"]]) {
    await page.click(`[data-tab="${tab}"]`);
    await page.waitForFunction((own) => document.querySelector("#playground .figures div:last-child")?.shadowRoot?.textContent.includes(own), words, { timeout: 60_000 });
  }
  await page.waitForSelector("#playground .model canvas", { timeout: 60_000 });
});

await test("a stopped engine starts again", async () => {
  await page.evaluate(() => globalThis.playground.engine.settle({ id: -1, trap: "a test" }));
  await page.click('[data-place="run"]');
  await page.evaluate(() => globalThis.playground.load("half-turn", globalThis.playground.examples.get("half-turn")));
  await page.waitForFunction(() => document.querySelector("#playground .verdict").textContent.includes("1 of 1 requirement met"), null, { timeout: 60_000 });
});

await test("a shared address opens its text", async () => {
  await page.click('[data-place="share"]');
  await page.waitForFunction(() => location.hash.startsWith("#toml="));
  const other = await opened(1400, page.url());
  await ready(other);
  assert((await verdict(other)).includes("1 of 1 requirement met"), "another verdict");
  await other.close();
});

for (const name of COMPARED) {
  await test(`the log of ${name} is that of the command`, async () => {
    const folder = mkdtempSync(join(tmpdir(), "flexsc-"));
    execFileSync(command, ["simulate", join(ROOT, `scenarios/${name}.toml`), "-o", folder], { stdio: "ignore" });
    const native = createHash("sha256").update(readFileSync(join(folder, `${name}.mcap`))).digest("hex");
    await page.evaluate((own) => {
      document.querySelector('[data-place="hash"]').dataset.sha256 = "";
      globalThis.playground.load(own, globalThis.playground.examples.get(own));
    }, name);
    await ready(page);
    const own = await page.getAttribute('[data-place="hash"]', "data-sha256");
    assert(own === native, `${own} in the browser, ${native} natively`);
    return own.slice(0, 16);
  });
}

await test("without a server, the page works from its folder", async () => {
  const alone = await opened(1400, `file://${SITE}/playground.html#relay-fixed`);
  await alone.waitForSelector("#playground .verdict", { timeout: 60_000 });
  await alone.close();
});

await test("pages fit screens of 1400 and 420 px", async () => {
  for (const width of [1400, 420]) {
    for (const path of ["index", "playground", "start", "examples/earth-observer", "reference/python", "tutorials/cubesat", "install"]) {
      const own = await opened(width, `${base}/${path}.html`);
      if (path === "playground") await ready(own);
      await own.screenshot({ path: join(ROOT, `target/site-${path.replace("/", "-")}-${width}.png`), fullPage: path === "index" });
      assert(await isNarrow(own), `${path} is wider than ${width} px`);
      await own.close();
    }
  }
});

await test("the search finds first what readers mean", async () => {
  const own = await opened(1400, `${base}/glossary.html`);
  const wrong = [];
  for (const [query, expected] of Object.entries(QUERIES)) {
    await own.fill(".md-search__input", "");
    await own.click(".md-search__input");
    await own.keyboard.type(query);
    await own.waitForTimeout(700);
    const first = await own.getAttribute(".md-search-result__link >> nth=0", "href").catch(() => "nothing");
    if (!new URL(first, base).pathname.startsWith(`/${expected}.html`)) wrong.push(`${query}: ${first}`);
  }
  assert(wrong.length === 0, wrong.join("\n"));
});

await browser.close();
server.close();
console.log(`${passed.length} passed, ${process.exitCode ? "some" : "none"} failed`);
