// Bundles the playground into one folder: `node bundle.mjs FOLDER`. The worker becomes a text within the page's script, so that the
// page also works from a folder.

import { build } from "esbuild";

const [folder] = process.argv.slice(2);
const common = { bundle: true, minify: true, format: "iife", target: "es2022", legalComments: "linked", logLevel: "warning" };
const worker = {
  name: "worker",
  setup(builder) {
    builder.onResolve({ filter: /^worker:/ }, ({ path, resolveDir }) => ({ path: `${resolveDir}/${path.slice(7)}`, namespace: "worker" }));
    builder.onLoad({ filter: /.*/, namespace: "worker" }, async ({ path }) => {
      const { outputFiles } = await build({ ...common, legalComments: "none", entryPoints: [path], write: false });
      return { contents: outputFiles[0].text, loader: "text" };
    });
  },
};
await build({ ...common, entryPoints: ["load.js", "main.js", "model.js"], outdir: folder, plugins: [worker] });
