// Opens a log with its layout in a whole viewer, and takes a picture of every tab at some times.
//
//   npm install && node check_viewer.mjs LOG LAYOUT DIR [SECONDS...]
//
// The viewer is Lichtblick if $LICHTBLICK is the directory of its web build (`yarn web:build:prod` makes web/.webpack of its
// sources); else the last Foxglove Studio whose source is open, from which it comes. It runs in Chromium without a window
// ($CHROMIUM, or /usr/bin/chromium). Problems that it tells of, and errors of its page, fail.

import assert from "node:assert/strict";
import { mkdirSync, readFileSync } from "node:fs";
import { basename, join } from "node:path";
import { chromium } from "playwright-core";

const [log, layout, directory, ...times] = process.argv.slice(2);
assert(directory, "usage: node check_viewer.mjs LOG LAYOUT DIR [SECONDS...]");
const { open } = await import(process.env.LICHTBLICK ? "./lichtblick.mjs" : "./studio.mjs");
const tabs = Object.values(JSON.parse(readFileSync(layout)).configById).find((config) => config.tabs)?.tabs ?? [{}];
const viewer = await open(log, layout);

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking"],
});
mkdirSync(directory, { recursive: true });
for (const [index, { title = "all" }] of tabs.entries()) {
  const page = await browser.newPage({ viewport: { width: 1600, height: 950 }, colorScheme: "light", timezoneId: "UTC" });
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  const view = await viewer.show(page, index);
  const { end } = view;
  for (const time of times.length > 0 ? times.map(Number) : [0, end / 4, end]) {
    const began = Date.now();
    await view.seek(time);
    console.log(`${basename(log)}, ${title}: at ${time} s after ${((Date.now() - began) / 1000).toFixed(0)} s`);
    const name = `${title.toLowerCase().replaceAll(" ", "-")}-${time}.png`;
    await page.screenshot({ path: join(directory, name) });
  }
  assert.deepEqual([...(await view.problems()), ...errors], [], `${title}: the viewer has problems`);
  console.log(`${basename(log)}, ${title}: no problems`);
  await page.close();
}
await browser.close();
viewer.close();
