// The text of a scenario in the address after `#`, compressed; nothing is sent.

async function through(stream, bytes) {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

const PREFIX = "toml=";

export async function packed(name, text) {
  const bytes = await through(new CompressionStream("deflate-raw"), new TextEncoder().encode(`${name}\n${text}`));
  const letters = btoa(String.fromCharCode(...bytes));
  return PREFIX + letters.replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

// The name and the text that an address has, or the name alone of an example.
export async function unpacked(hash) {
  const own = decodeURIComponent(hash.replace(/^#/, ""));
  if (!own.startsWith(PREFIX)) return { name: own };
  const letters = own.slice(PREFIX.length).replaceAll("-", "+").replaceAll("_", "/");
  const bytes = Uint8Array.from(atob(letters), (letter) => letter.charCodeAt(0));
  const [name, ...lines] = new TextDecoder().decode(await through(new DecompressionStream("deflate-raw"), bytes)).split("\n");
  return { name, text: lines.join("\n") };
}

export async function sha256(bytes) {
  // Pages that are opened from a folder or a plain server have no `crypto.subtle` in some browsers.
  if (!globalThis.crypto?.subtle) return null;
  const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", bytes));
  return [...digest].map((byte) => byte.toString(16).padStart(2, "0")).join("");
}
