// Stores the state of the page in the fragment of its address as deflated JSON: back, reload and bookmarks work.

const NAME = "s";

async function pipe(stream, bytes) {
  const writer = stream.writable.getWriter();
  writer.write(bytes);
  writer.close();
  return new Uint8Array(await new Response(stream.readable).arrayBuffer());
}

/** Return the state as text for an address. */
export async function pack(state) {
  const bytes = new TextEncoder().encode(JSON.stringify(state));
  const small = await pipe(new CompressionStream("deflate-raw"), bytes);
  let text = "";
  for (const byte of small) text += String.fromCharCode(byte);
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

/** Return the state of a text of `pack`; null for any other text. */
export async function unpack(text) {
  try {
    const plain = atob(text.replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(plain, (x) => x.charCodeAt(0));
    const inflated = await pipe(new DecompressionStream("deflate-raw"), bytes);
    return JSON.parse(new TextDecoder().decode(inflated));
  } catch {
    return null;
  }
}

/** Return the state in the address, or null. */
export async function readAddress() {
  const text = new URLSearchParams(location.hash.slice(1)).get(NAME);
  return text ? unpack(text) : null;
}

/** Write the state into the address, as a new history entry if `isNew`, else replacing the present one. */
export async function writeAddress(state, isNew) {
  const address = `${location.pathname}#${NAME}=${await pack(state)}`;
  if (address === location.pathname + location.hash) return;
  if (isNew) history.pushState(null, "", address);
  else history.replaceState(null, "", address);
}
