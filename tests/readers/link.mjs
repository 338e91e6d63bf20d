// Serves a log and its layout to a viewer, and prints the link that opens both.
//
//   node link.mjs LOG LAYOUT [VIEWER]
//
// The viewer is Lichtblick where it is hosted, or at another address, whose pages alone may read the files.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { serve } from "./serve.mjs";

const [log, layout, viewer = "https://lichtblick-suite.github.io/lichtblick/"] = process.argv.slice(2);
assert(layout, "usage: node link.mjs LOG LAYOUT [VIEWER]");
const files = { "/log.mcap": readFileSync(log), "/layout.json": readFileSync(layout) };
const { origin } = await serve(({ pathname }) => files[pathname], new URL(viewer).origin);
const link = new URL(viewer);
link.search = new URLSearchParams({ ds: "remote-file", "ds.url": `${origin}/log.mcap`, layoutUrl: `${origin}/layout.json` });
console.log(`${link}`);
