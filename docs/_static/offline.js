// Asks the browser to keep what is visited, for readers without a network. A page opened from a file keeps nothing.

(() => {
  if (!("serviceWorker" in navigator) || !location.protocol.startsWith("http")) return;
  const site = new URL("..", document.currentScript.src);

  /** All that this page consists of; pictures further down and hints as well, unless the reader wants to save data. */
  function parts() {
    const loaded = performance.getEntriesByType("resource").map((entry) => entry.name);
    const later = navigator.connection?.saveData ? [] : [...document.images].map((image) => image.src);
    const chapter = document.querySelector("[data-exercise]")?.dataset.exercise.split(".")[0].toLowerCase();
    if (chapter && later.length) later.push(new URL(`_static/exercises/help-${chapter}.json`, site).href);
    return [location.href.split("#")[0], ...loaded, ...later];
  }

  addEventListener("load", async () => {
    try {
      await navigator.serviceWorker.register(new URL("service-worker.js", site), { updateViaCache: "none" });
      const { active } = await navigator.serviceWorker.ready;
      active.postMessage({ visited: [...new Set(parts())] });
    } catch {
      // a browser that forbids it, as some do in a private window: the page works without
    }
  });
})();
