// The site's search runs in a worker, and browsers start none for pages opened from a disk.
// For such pages this file defines `Worker` by an invisible frame.
if (location.protocol === "file:") {
  window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      this.frame = document.createElement("iframe");
      this.frame.hidden = true;
      document.body.appendChild(this.frame);
      const inside = this.frame.contentWindow;
      window.addEventListener("message", (event) => {
        if (event.source !== inside) return;
        const told = new MessageEvent("message", { data: event.data });
        this.dispatchEvent(told);
        if (this.onmessage) this.onmessage(told);
      });
      this.ready = new Promise((resolve) => {
        const page = inside.document;
        page.open();
        page.write(
          "<script>self.IFrameWorker = true; postMessage = parent.postMessage.bind(parent);" +
            "importScripts = (...urls) => urls.reduce((all, url) => all.then(() => new Promise((ok, no) => {" +
            "const s = document.createElement('script'); s.src = url; s.onload = ok; s.onerror = no;" +
            "document.body.appendChild(s); })), Promise.resolve())<\/script><body></body>",
        );
        page.close();
        const script = page.createElement("script");
        script.src = new URL(url, location.href);
        script.onload = resolve;
        page.body.appendChild(script);
      });
    }

    postMessage(data) {
      this.ready.then(() =>
        this.frame.contentWindow.dispatchEvent(
          new MessageEvent("message", { data, source: window }),
        ),
      );
    }

    terminate() {
      this.frame.remove();
    }
  };
}
