// Sends questions to the server: POST with the token; the answer is JSON lines.

import { recall, remember } from "studio/store";

const KEY = "token";
let token = "";

/** Move the token out of the address, so it is not copied with it; bookmarks use the last token. */
export function takeToken() {
  const fragment = new URLSearchParams(location.hash.slice(1));
  token = fragment.get("token") ?? recall(KEY, "");
  if (fragment.has("token")) {
    remember(KEY, token);
    fragment.delete("token");
    history.replaceState(history.state, "", `${location.pathname}#${fragment}`);
  }
  return token;
}

const HEADERS = () => ({ "content-type": "application/json", "x-roadproof-token": token });

/** Return the content that the page starts with. Throws an Error with a message for the user. */
export async function start() {
  const answer = await fetch("/start", { method: "POST", headers: HEADERS(), body: "{}" });
  const data = await answer.json();
  if (!answer.ok) throw new Error(data.error);
  return data;
}

/**
 * Return the answer to a question: {answer} or {error}, with seconds. `onMessage` gets the stages meanwhile; aborting
 * `signal` ends the job. Throws an Error where the server does not respond or refuses.
 */
export async function ask(kind, question, { onMessage = () => {}, signal } = {}) {
  const body = JSON.stringify({ kind, ...question });
  const reply = await fetch("/ask", { method: "POST", headers: HEADERS(), body, signal });
  if (!reply.ok) throw new Error((await reply.json()).error);
  const reader = reply.body.getReader();
  const decoder = new TextDecoder();
  let rest = "";
  let last = null;
  for (;;) {
    const { value, done } = await reader.read();
    if (done && last) return last;
    if (done) throw new Error("the server ended before it had answered");
    const lines = (rest + decoder.decode(value, { stream: true })).split("\n");
    rest = lines.pop();
    for (const line of lines) {
      const message = JSON.parse(line);
      if ("answer" in message || "error" in message) last = message;
      else onMessage(message);
    }
  }
}
