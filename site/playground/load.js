// Loads the page's script, which is compressed.

import { unpackedScript } from "./packed.js";

unpackedScript("main.js").catch((error) => {
  document.querySelector("#playground").textContent = error.message;
});
