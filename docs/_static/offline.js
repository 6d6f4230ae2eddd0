// Asks the browser to keep what is visited, for readers without a network. A page opened from a file keeps nothing.

(() => {
  if (!("serviceWorker" in navigator) || !location.protocol.startsWith("http")) return;
  const site = new URL("..", document.currentScript.src);
  const isNew = !navigator.serviceWorker.controller; // then this page came without the service worker's help

  /** Everything that this page consists of, pictures further down as well unless the reader wants to save data. */
  function parts() {
    const loaded = performance.getEntriesByType("resource").map((entry) => entry.name);
    const pictures = navigator.connection?.saveData ? [] : [...document.images].map((image) => image.src);
    return [location.href.split("#")[0], ...loaded, ...pictures];
  }

  addEventListener("load", async () => {
    try {
      await navigator.serviceWorker.register(new URL("service-worker.js", site), { updateViaCache: "none" });
      const { active } = await navigator.serviceWorker.ready;
      if (isNew) active.postMessage({ visited: [...new Set(parts())] });
    } catch {
      // a browser that forbids it, as some do in a private window: the page works without
    }
  });
})();
