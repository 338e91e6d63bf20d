// Lichtblick as it is built for the web, with a log and a layout that its link names.

import { readFileSync } from "node:fs";
import { join } from "node:path";
import { McapIndexedReader } from "@mcap/core";
import { loadDecompressHandlers } from "@mcap/support";
import { serve } from "./serve.mjs";

// Start and end of a log (ns).
async function range(bytes) {
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (from, length) => new Uint8Array(bytes.subarray(Number(from), Number(from + length))),
  };
  const { statistics } = await McapIndexedReader.Initialize({ readable, decompressHandlers: await loadDecompressHandlers() });
  return [statistics.messageStartTime, statistics.messageEndTime];
}

// The layout with this tab in front.
function layoutOf(path, tab) {
  const data = JSON.parse(readFileSync(path));
  for (const config of Object.values(data.configById)) {
    if (config.tabs) config.activeTabIdx = tab;
  }
  return Buffer.from(JSON.stringify(data));
}

export async function open(log, layout) {
  const bytes = readFileSync(log);
  const [start, end] = await range(bytes);
  const { origin, close } = await serve(({ pathname }) => {
    const tab = /^\/layout-(\d+)\.json$/.exec(pathname)?.[1];
    if (tab) return layoutOf(layout, Number(tab));
    if (pathname === "/log.mcap") return bytes;
    return join(process.env.LICHTBLICK, pathname === "/" ? "index.html" : pathname.slice(1));
  });
  const show = async (page, tab) => {
    const problems = [];
    const seek = async (seconds) => {
      const time = new Date(Number(start) / 1e6 + seconds * 1e3).toISOString();
      const query = { ds: "remote-file", "ds.url": `${origin}/log.mcap`, layoutUrl: `${origin}/layout-${tab}.json`, time };
      await page.goto(`${origin}/?${new URLSearchParams(query)}`);
      await page.getByTestId("play-button").waitFor({ timeout: 120_000 });
      await loaded(page);
      // What it has to say stands in the sidebar, which then only takes room.
      await page.getByTestId("alerts-left").click();
      const said = await page.getByTestId("sidebar-left").innerText();
      if (!said.includes("No alerts found")) problems.push(said);
      await page.getByTestId("sidebar-close-left").click();
      await page.waitForTimeout(3000);
    };
    return { seek, problems: async () => problems, end: Number(end - start) / 1e9 };
  };
  return { show, close };
}

// Waits until the log is loaded: until the page looks the same for some seconds. The bar below the slider tells of a part only.
async function loaded(page) {
  for (let [before, same] = ["", 0]; same < 3; ) {
    await page.waitForTimeout(3000);
    const now = (await page.screenshot({ timeout: 300_000 })).toString("base64");
    [before, same] = [now, now === before ? same + 1 : 0];
  }
}
