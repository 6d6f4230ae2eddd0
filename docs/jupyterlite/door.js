// The door to a notebook in the page. Before JupyterLite begins its service worker is put in place; above the notebook
// there is a line with the way back, with what is being loaded, and with what a reader does most.

const LITE = new URL(".", import.meta.url);
const SITE = new URL("..", LITE);
const KERNEL = "@jupyterlite/pyodide-kernel-extension:kernel";
const PAGE = `loopbook ${Math.random()}`; // the channel on which this page's Python tells how far it is

const line = document.createElement("header");
line.id = "loopbook";
line.innerHTML = `
  <a>← Back to the page</a>
  <span class="says" role="status">The notebook is being opened.</span>
  <progress max="1" hidden></progress>
  <span class="buttons">
    <button data-does="run" disabled>Run all cells</button>
    <button data-does="download" disabled title="The notebook with your changes, as a file">Download</button>
    <button data-does="fresh" disabled title="The notebook as it was before your changes">Start afresh</button>
  </span>`;
const [back, says, progress] = ["a", ".says", "progress"].map((part) => line.querySelector(part));
document.body.prepend(line);

/** The address of a notebook's page on the site, or of the front page. */
function pageOf(path) {
  const known = /^(chapters|solutions)\/(?!00_)\w+(?=\.ipynb$)/.exec(path);
  return new URL(known ? `${known[0]}.html` : "index.html", SITE);
}

/**
 * Have JupyterLite's service worker in charge of this page before JupyterLite looks for one.
 *
 * A service worker of the whole site would otherwise be taken for JupyterLite's; and one of a version that JupyterLite
 * does not remember makes it take away every service worker there is.
 */
async function withServiceWorker(version) {
  const { serviceWorker } = navigator;
  if (!serviceWorker) return;
  const address = new URL("service-worker.js?enableCache=false", LITE).href;
  localStorage.setItem(`${address}-version`, version);
  const inCharge = () => serviceWorker.controller?.scriptURL === address;
  if (inCharge()) return;
  await serviceWorker.register(address);
  await new Promise((resolve) => {
    const look = () => inCharge() && resolve();
    serviceWorker.addEventListener("controllerchange", look);
    look();
  });
  // what came before is fetched once more, so that it is stored too
  await Promise.all([location.href, import.meta.url, new URL("door.css", LITE)].map((address) => fetch(address)));
}

/** Start JupyterLite, with a channel for what its Python tells. */
async function start() {
  await import("./config-utils.js");
  const configuration = document.getElementById("jupyter-config-data");
  const config = JSON.parse(configuration.textContent);
  config.litePluginSettings[KERNEL].loadPyodideOptions.page = PAGE;
  configuration.textContent = JSON.stringify(config);
}

/** What Python tells while it is loaded, in words. */
function told({ data: { bytes, of, again, starts, ready, problem } }) {
  if (bytes) {
    const how = again ? "is taken from this browser" : "is being loaded, once";
    says.textContent = `Python ${how}: ${Math.round(bytes / 1e6)} of ${Math.round(of / 1e6)} MB.`;
    progress.value = bytes / of;
  }
  if (starts) says.textContent = "Python starts.";
  if (ready) says.textContent = "Python is ready. Your changes are kept in this browser.";
  if (problem) says.textContent = `${problem} Reload the page to try again.`;
  progress.hidden = !bytes;
  line.classList.toggle("problem", Boolean(problem));
}

/** What the buttons do, when JupyterLite is there; the list of all notebooks has none. */
async function serve() {
  if (document.body.dataset.notebook !== "notebooks") {
    back.textContent = "← Back to the book";
    says.textContent = "What you change is kept in this browser.";
    line.querySelector(".buttons").remove();
    return;
  }
  const app = await jupyterApp();
  const path = () => app.shell.currentWidget?.context?.path ?? "";
  const does = {
    run() {
      const { content } = app.shell.currentWidget;
      const here = content.activeCellIndex;
      app.commands.execute("notebook:run-all-cells");
      content.activeCellIndex = here; // the reader stays where she is, and not at the end
      content.scrollToItem(here, "smart").catch(() => {});
    },
    download: () => app.commands.execute("docmanager:download"),
    async fresh() {
      if (!confirm("Put the notebook back to how it was? What you have changed in it is lost; Download keeps it as a file.")) return;
      await app.shell.currentWidget.context.save();
      await app.serviceManager.contents.delete(path());
      location.reload();
    },
  };
  for (const button of line.querySelectorAll("button")) {
    button.addEventListener("click", does[button.dataset.does]);
    button.disabled = false;
  }
  keepWork(app);
}

/** Save a moment after each change and when the page is left; JupyterLab's own rhythm may take half a minute. */
async function keepWork(app) {
  while (!app.shell.currentWidget?.context) await new Promise((resolve) => setTimeout(resolve, 100));
  const { context } = app.shell.currentWidget;
  await context.ready;
  // JupyterLab calls a notebook saved that was changed while it was being saved: what is kept is counted here.
  let changes = 0, kept = 0, isSaving = false, timer;
  async function save() {
    clearTimeout(timer);
    if (isSaving) return;
    isSaving = true;
    try {
      while (kept < changes) {
        const upTo = changes;
        await context.save();
        kept = upTo;
      }
    } catch (problem) {
      says.textContent = `Not kept: ${problem.message}`;
    }
    isSaving = false;
  }
  context.model.contentChanged.connect(() => {
    changes += 1;
    clearTimeout(timer);
    timer = setTimeout(save, 1000);
  });
  document.addEventListener("visibilitychange", save);
  window.addEventListener("beforeunload", (event) => {
    if (kept === changes) return;
    save();
    event.preventDefault(); // the browser asks, and meanwhile it is saved
  });
}

async function jupyterApp() {
  while (!globalThis.jupyterapp) await new Promise((resolve) => setTimeout(resolve, 50));
  await globalThis.jupyterapp.restored;
  return globalThis.jupyterapp;
}

back.href = pageOf(new URLSearchParams(location.search).get("path") ?? "");
new BroadcastChannel(PAGE).addEventListener("message", told);
await withServiceWorker(document.documentElement.dataset.version);
await start();
await serve();
