// A file server on this machine, for pages of its own and of others: with ranges, which viewers need of a log.

import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname } from "node:path";

const types = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml", ".wasm": "application/wasm", ".json": "application/json" };

// Serves what `find` gives for a URL: bytes, or the path of a file; a port of its own is chosen. Pages of `reader` may read it.
export async function serve(find, reader) {
  const server = createServer((request, response) => {
    const url = new URL(request.url, "http://localhost");
    for (const [name, value] of [
      ["Cross-Origin-Opener-Policy", "same-origin"],
      ["Cross-Origin-Embedder-Policy", "credentialless"],
      ...(reader ? [["Access-Control-Allow-Origin", reader], ["Access-Control-Allow-Headers", "Range"], ["Access-Control-Allow-Private-Network", "true"]] : []),
      ["Access-Control-Expose-Headers", "Accept-Ranges, Content-Length, Content-Range"],
      ["Accept-Ranges", "bytes"],
    ]) {
      response.setHeader(name, value);
    }
    if (request.method === "OPTIONS") {
      response.writeHead(204).end();
      return;
    }
    try {
      const found = find(url);
      const bytes = typeof found === "string" ? readFileSync(found) : found;
      const type = types[extname(typeof found === "string" ? found : url.pathname)] ?? "application/octet-stream";
      const [, from, to] = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range ?? "") ?? [];
      const part = from === undefined ? bytes : bytes.subarray(Number(from), to ? Number(to) + 1 : undefined);
      if (from !== undefined) {
        response.setHeader("Content-Range", `bytes ${from}-${Number(from) + part.length - 1}/${bytes.length}`);
      }
      response.writeHead(from === undefined ? 200 : 206, { "Content-Type": type, "Content-Length": part.length });
      response.end(request.method === "HEAD" ? undefined : part);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return { origin: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}
