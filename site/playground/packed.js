// Files that the page needs are compressed: from a server as they are; from a folder, where nothing may be fetched, in base64 within a
// script. Their folder is that of the first script: a compressed one has no place of its own.

const folder = (globalThis.FLEXSC_FOLDER ??= document.currentScript.src.replace(/[^/]*$/, ""));

export async function script(src) {
  return new Promise((resolve, reject) => {
    const element = document.createElement("script");
    Object.assign(element, { src, onload: resolve, onerror: () => reject(new Error(`${src} cannot be read`)) });
    document.head.append(element);
  });
}

async function packed(name) {
  if (location.protocol !== "file:") {
    const response = await fetch(`${folder}${name}.gz`);
    if (!response.ok) throw new Error(`${response.url}: ${response.status}`);
    return new Uint8Array(await response.arrayBuffer());
  }
  await script(`${folder}${name}.gz.js`);
  return Uint8Array.from(atob(globalThis.FLEXSC_FILES[name]), (letter) => letter.charCodeAt(0));
}

export async function unpackedFile(name) {
  const bytes = await packed(name);
  // Some servers unpack what ends in .gz.
  if (bytes[0] !== 0x1f || bytes[1] !== 0x8b) return bytes;
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

// Runs a compressed script.
export async function unpackedScript(name) {
  const address = URL.createObjectURL(new Blob([await unpackedFile(name)], { type: "text/javascript" }));
  await script(address);
  URL.revokeObjectURL(address);
}
