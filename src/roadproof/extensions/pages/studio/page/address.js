// The state of the page in the fragment of its address: deflated JSON, so that back, reload and bookmarks work.

const NAME = "s";

async function through(stream, bytes) {
  const writer = stream.writable.getWriter();
  writer.write(bytes);
  writer.close();
  return new Uint8Array(await new Response(stream.readable).arrayBuffer());
}

/** The state as text for an address. */
export async function pack(state) {
  const bytes = new TextEncoder().encode(JSON.stringify(state));
  const small = await through(new CompressionStream("deflate-raw"), bytes);
  let text = "";
  for (const byte of small) text += String.fromCharCode(byte);
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

/** The inverse of `pack`; null where the text is none of ours. */
export async function unpack(text) {
  try {
    const plain = atob(text.replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(plain, (x) => x.charCodeAt(0));
    const found = await through(new DecompressionStream("deflate-raw"), bytes);
    return JSON.parse(new TextDecoder().decode(found));
  } catch {
    return null;
  }
}

/** The state that the address has, or null. */
export async function fromAddress() {
  const text = new URLSearchParams(location.hash.slice(1)).get(NAME);
  return text ? unpack(text) : null;
}

/** Put the state into the address, as a new entry of the history or in place of the present one. */
export async function toAddress(state, isNew) {
  const address = `${location.pathname}#${NAME}=${await pack(state)}`;
  if (address === location.pathname + location.hash) return;
  if (isNew) history.pushState(null, "", address);
  else history.replaceState(null, "", address);
}
