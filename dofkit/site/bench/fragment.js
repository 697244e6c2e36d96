// A link is the document: the scene, deflated, as base64url in the fragment, which is sent to nobody.

/** Characters of a fragment, and bytes of a scene, that are read at most. */
const LONGEST = 100_000;
const MOST_BYTES = 200_000;

/** @param {string} text */
export async function packed(text) {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const letters = Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");
  return btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** The text of a fragment. Throws an Error for one that is broken or too long. @param {string} fragment */
export async function unpacked(fragment) {
  if (fragment.length > LONGEST) throw new Error("the link is too long");
  const bytes = Uint8Array.from(atob(fragment.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw")).getReader();
  const decoder = new TextDecoder("utf-8", { fatal: true });
  let text = "";
  for (let size = 0, step = await reader.read(); !step.done; step = await reader.read()) {
    size += step.value.length;
    if (size > MOST_BYTES) {
      await reader.cancel();
      throw new Error("the scene in the link is too large");
    }
    text += decoder.decode(step.value, { stream: true });
  }
  return text + decoder.decode();
}
