// The last Foxglove Studio whose source is open, with one log and one layout, and no other source, storage or account.

import { createRequire } from "node:module";
import { basename, dirname, join } from "node:path";
import { serve } from "./serve.mjs";

const require = createRequire(import.meta.url);
const packageOf = (name) => dirname(require.resolve(`${name}/package.json`));

// Runs in the page.
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

const html = `<!doctype html><meta charset="utf-8"><style>html, body, #root { height: 100%; margin: 0 }</style>
<script src="/react.js"></script><script src="/react-dom.js"></script>
<script>window.global = window; window.react = React; window["react-dom"] = ReactDOM; window.FOXGLOVE_STUDIO_VERSION = "";</script>
<script src="/assets/index.js"></script><div id="root"></div><script>(${start})()</script>`;

export async function open(log, layout) {
  const files = {
    "/index.html": Buffer.from(html),
    "/log.mcap": log,
    "/layout.json": layout,
    "/react.js": join(packageOf("react"), "umd/react.production.min.js"),
    "/react-dom.js": join(packageOf("react-dom"), "umd/react-dom.production.min.js"),
  };
  const assets = join(packageOf("@foxglove/studio-base"), "assets");
  const { origin, close } = await serve(({ pathname }) => files[pathname] ?? join(assets, basename(pathname)));
  const show = async (page, tab) => {
    await page.goto(`${origin}/index.html?tab=${tab}`);
    await page.waitForFunction(() => window.state?.presence === "PRESENT" && window.state.activeData, undefined, { timeout: 120_000 });
    // The sidebar of the source, and a tip for newcomers.
    await page.mouse.click(25, 25);
    const tip = page.getByText("Open settings to configure").locator("..").getByRole("button");
    await tip.click({ timeout: 5000 }).catch(() => {});
    const end = await page.evaluate(() => {
      const { startTime, endTime } = window.state.activeData;
      return endTime.sec - startTime.sec + (endTime.nsec - startTime.nsec) / 1e9;
    });
    const seek = async (time) => {
      await page.evaluate((seconds) => {
        const { sec, nsec } = window.state.activeData.startTime;
        const at = sec * 1e9 + nsec + seconds * 1e9;
        window.player.seekPlayback({ sec: Math.floor(at / 1e9), nsec: Math.round(at % 1e9) });
      }, time);
      await page.waitForTimeout(6000);
    };
    const problems = () => page.evaluate(() => (window.state.problems ?? []).map(({ message }) => message));
    return { seek, problems, end };
  };
  return { show, close };
}
