// Questions to the server: POST with the token, answered by JSON lines.

import { recall, remember } from "studio/store";

const KEY = "token";
let token = "";

/** Take the token out of the address, so that it is not copied with it; a bookmark uses the last one. */
export function takeToken() {
  const found = new URLSearchParams(location.hash.slice(1));
  token = found.get("token") ?? recall(KEY, "");
  if (found.has("token")) {
    remember(KEY, token);
    found.delete("token");
    history.replaceState(history.state, "", `${location.pathname}#${found}`);
  }
  return token;
}

const HEADERS = () => ({ "content-type": "application/json", "x-roadproof-token": token });

/** What the server was started with. Throws an Error with words for the user. */
export async function start() {
  const answer = await fetch("/start", { method: "POST", headers: HEADERS(), body: "{}" });
  const data = await answer.json();
  if (!answer.ok) throw new Error(data.error);
  return data;
}

/**
 * The answer to a question: {answer} or {error}, with seconds. `hear` is told of stages meanwhile; aborting
 * `signal` ends the job. Throws an Error where the server is not there or refuses.
 */
export async function ask(kind, question, { hear = () => {}, signal } = {}) {
  const body = JSON.stringify({ kind, ...question });
  const reply = await fetch("/ask", { method: "POST", headers: HEADERS(), body, signal });
  if (!reply.ok) throw new Error((await reply.json()).error);
  const reader = reply.body.getReader();
  const words = new TextDecoder();
  let rest = "";
  let last = null;
  for (;;) {
    const { value, done } = await reader.read();
    if (done && last) return last;
    if (done) throw new Error("the server ended before it had answered");
    const lines = (rest + words.decode(value, { stream: true })).split("\n");
    rest = lines.pop();
    for (const line of lines) {
      const message = JSON.parse(line);
      if ("answer" in message || "error" in message) last = message;
      else hear(message);
    }
  }
}
