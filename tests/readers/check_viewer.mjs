// Opens a log with its layout in a whole viewer, and takes a picture of every tab at some times.
//
//   npm install && node check_viewer.mjs LOG LAYOUT DIR [SECONDS...]
//
// The viewer is the last Foxglove Studio whose source is open, from which Lichtblick comes; it runs in Chromium without a
// window ($CHROMIUM, or /usr/bin/chromium). Problems that it tells of, and errors of its page, fail.

import assert from "node:assert/strict";
import { mkdirSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { basename, dirname, extname, join } from "node:path";
import { chromium } from "playwright-core";

const require = createRequire(import.meta.url);
const packageOf = (name) => dirname(require.resolve(`${name}/package.json`));
const [log, layout, directory, ...times] = process.argv.slice(2);
assert(directory, "usage: node check_viewer.mjs LOG LAYOUT DIR [SECONDS...]");
const tabs = Object.values(JSON.parse(readFileSync(layout)).configById).find((config) => config.tabs)?.tabs ?? [{}];

// Runs in the page: the viewer with one log and one layout, and no other source, storage or account.
async function start() {
  const tab = Number(new URLSearchParams(location.search).get("tab"));
  const data = await (await fetch("/layout.json")).json();
  for (const config of Object.values(data.configById)) {
    if (config.tabs) config.activeTabIdx = tab;
  }
  const file = new File([await (await fetch("/log.mcap")).blob()], "log.mcap");
  const only = { id: "only", name: "only", permission: "CREATOR_WRITE", baseline: { data, savedAt: new Date(0).toISOString() } };
  localStorage.setItem("studio.profile-data", JSON.stringify({ currentLayoutId: only.id }));
  let kept = only;
  const layoutStorage = {
    list: async () => [kept],
    get: async () => kept,
    put: async (_, changed) => (kept = changed),
    delete: async () => {},
    importLayouts: async () => {},
  };
  const settings = new Map([["colorScheme", "light"], ["timezone", "UTC"], ["telemetry.telemetryEnabled", false]]);
  const appConfiguration = {
    get: (key) => settings.get(key),
    set: async (key, value) => void settings.set(key, value),
    addChangeListener() {},
    removeChangeListener() {},
  };
  const files = new window.McapLocalDataSourceFactory();
  const source = {
    id: "flexsc",
    type: "connection",
    displayName: "flexsc",
    initialize(given) {
      const player = files.initialize({ ...given, file });
      const listen = player.setListener.bind(player);
      player.setListener = (listener) => listen(async (state) => listener((window.state = state)));
      return (window.player = player);
    },
  };
  await window.initI18n();
  const deepLinks = [`${location.origin}/?ds=flexsc&ds.x=1`];
  const given = { deepLinks, appConfiguration, dataSources: [source], layoutStorage, extensionLoaders: [], enableGlobalCss: true };
  ReactDOM.render(React.createElement(window.App, given), document.getElementById("root"));
}

const page = `<!doctype html><meta charset="utf-8"><style>html, body, #root { height: 100%; margin: 0 }</style>
<script src="/react.js"></script><script src="/react-dom.js"></script>
<script>window.global = window; window.react = React; window["react-dom"] = ReactDOM; window.FOXGLOVE_STUDIO_VERSION = "";</script>
<script src="/assets/index.js"></script><div id="root"></div><script>(${start})()</script>`;
const files = {
  "/log.mcap": log,
  "/layout.json": layout,
  "/react.js": join(packageOf("react"), "umd/react.production.min.js"),
  "/react-dom.js": join(packageOf("react-dom"), "umd/react-dom.production.min.js"),
};
const types = { ".js": "text/javascript", ".wasm": "application/wasm", ".json": "application/json" };
const server = createServer((request, response) => {
  const { pathname } = new URL(request.url, "http://localhost");
  response.setHeader("Cross-Origin-Opener-Policy", "same-origin");
  response.setHeader("Cross-Origin-Embedder-Policy", "require-corp");
  if (pathname === "/") {
    response.setHeader("Content-Type", "text/html");
    response.end(page);
    return;
  }
  const asset = join(packageOf("@foxglove/studio-base"), "assets", basename(pathname));
  const path = files[pathname] ?? (pathname.startsWith("/assets/") ? asset : undefined);
  try {
    const bytes = readFileSync(path);
    response.setHeader("Content-Type", types[extname(path)] ?? "application/octet-stream");
    response.end(bytes);
  } catch {
    response.statusCode = 404;
    response.end();
  }
});
await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking"],
});
mkdirSync(directory, { recursive: true });
for (const [index, { title = "all" }] of tabs.entries()) {
  const view = await browser.newPage({ viewport: { width: 1600, height: 950 } });
  const errors = [];
  view.on("pageerror", (error) => errors.push(String(error)));
  await view.goto(`http://127.0.0.1:${server.address().port}/?tab=${index}`);
  await view.waitForFunction(() => window.state?.presence === "PRESENT" && window.state.activeData, undefined, { timeout: 120_000 });
  // The sidebar of the source, and a tip for newcomers.
  await view.mouse.click(25, 25);
  const tip = view.getByText("Open settings to configure").locator("..").getByRole("button");
  await tip.click({ timeout: 5000 }).catch(() => {});
  const end = await view.evaluate(() => {
    const { startTime, endTime } = window.state.activeData;
    return endTime.sec - startTime.sec + (endTime.nsec - startTime.nsec) / 1e9;
  });
  for (const time of times.length > 0 ? times.map(Number) : [0, end / 4, end]) {
    await view.evaluate((seconds) => {
      const { sec, nsec } = window.state.activeData.startTime;
      const at = sec * 1e9 + nsec + seconds * 1e9;
      window.player.seekPlayback({ sec: Math.floor(at / 1e9), nsec: Math.round(at % 1e9) });
    }, time);
    await view.waitForTimeout(6000);
    const name = `${title.toLowerCase().replaceAll(" ", "-")}-${time}.png`;
    await view.screenshot({ path: join(directory, name) });
  }
  const problems = await view.evaluate(() => (window.state.problems ?? []).map(({ message }) => message));
  assert.deepEqual([...problems, ...errors], [], `${title}: the viewer has problems`);
  console.log(`${basename(log)}, ${title}: no problems`);
  await view.close();
}
await browser.close();
server.close();
