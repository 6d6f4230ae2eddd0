// Python for the notebooks in the page. JupyterLite's kernel asks this module for its Pyodide, in a worker.
//
// python.json (docs/browser/lite.py writes it) lists every package with its address, so that nothing is looked up
// anywhere and a notebook can import at once: those in pure Python come from the site, the others from where Pyodide is.
// How far all this is goes to the page, on the channel that it has opened (door.js).

// What every chapter imports. The reader sees that it takes its time before the first cell is run, and only once.
const EVERYWHERE = `
import pyodide_kernel, matplotlib.pyplot, scipy.optimize
import loopbook.exercises, loopbook.figures, loopbook.ledger, loopbook.sliders, loopbook.transfer
`;

const COMPILED = `loopbook compiled ${new URL(".", import.meta.url)}`;

// The kernel would install what a reader asks for with %pip. Here everything is there, and nothing else may be fetched.
const WITHOUT_PIP = `
import logging, sys, types
async def get_transformed_code(words):
    raise RuntimeError("nothing can be installed here: what the chapters need is there, and nothing else is fetched")
names = ["piplite", "piplite.piplite", "piplite.cli"]
package, package.piplite, package.cli = modules = [types.ModuleType(name) for name in names]
package.cli.get_transformed_code = get_transformed_code
sys.modules.update(zip(names, modules))
logging.getLogger("matplotlib.font_manager").setLevel(logging.ERROR)  # that it looks for fonts is no news for a reader
sys.dont_write_bytecode = False  # see Compiled
`;

export async function loadPyodide({ packagesURL, page, ...options }) {
  const channel = new BroadcastChannel(page);
  const listed = await (await fetch(packagesURL, { cache: "no-cache" })).json();
  const whole = (address) => new URL(address, packagesURL).href;
  const again = await wasHere(whole(`compiled-${listed.version}`));
  const counting = counted((bytes) => channel.postMessage({ bytes, of: listed.bytes, again }));
  try {
    const { loadPyodide } = await import(whole(`${listed.runtime}pyodide.mjs`));
    const python = await loadPyodide({
      ...options,
      indexURL: whole(listed.runtime),
      lockFileURL: lockFile(listed, whole),
      packages: Object.keys(listed.packages),
    });
    channel.postMessage({ starts: true });
    python.runPython(WITHOUT_PIP);
    const compiled = await Compiled.opened(python, packagesURL, whole(`compiled-${listed.version}`));
    python.runPython(EVERYWHERE);
    channel.postMessage({ ready: true });
    await compiled.keep();
    return python;
  } catch (problem) {
    const why = problem.message.trim().split("\n").pop();
    channel.postMessage({ problem: `Python cannot be loaded from ${new URL(whole(listed.runtime)).host} (${why}).` });
    throw problem;
  } finally {
    counting.end();
  }
}

// Whether this browser has run a notebook of this site before: then what is needed is in its store.
async function wasHere(address) {
  return Boolean(await self.caches?.match(address, { cacheName: COMPILED }).catch(() => undefined));
}

// The address of the list of packages in the form in which Pyodide reads it.
function lockFile({ info, packages }, whole) {
  const entries = Object.entries(packages).map(([name, one]) => [name, { ...one, file_name: whole(one.file_name) }]);
  return URL.createObjectURL(new Blob([JSON.stringify({ info, packages: Object.fromEntries(entries) })]));
}

// What Python compiled of the modules, kept in the browser: the next time they are there in half the time.
class Compiled {
  static async opened(python, base, address) {
    const source = await (await fetch(new URL("compiled.py", base))).text();
    const module = python.toPy({ __name__: "compiled" });
    python.runPython(source, { globals: module });
    const store = await self.caches?.open(COMPILED).catch(() => undefined);
    const kept = await store?.match(address);
    if (kept) module.get("restored")(python.toPy(new Uint8Array(await kept.arrayBuffer())));
    return Object.assign(new Compiled(), { module, store, address, kept });
  }

  async keep() {
    if (!this.store || this.kept) return;
    for (const older of await this.store.keys()) await this.store.delete(older);
    const bytes = this.module.get("gathered")().toJs();
    await this.store.put(this.address, new Response(bytes)).catch(() => undefined); // a full disk makes it slow only
  }
}

// Have this worker's fetch count the bytes that arrive, until end() is called.
function counted(report) {
  const plain = self.fetch;
  let bytes = 0;
  const counter = () =>
    new TransformStream({
      transform(piece, stream) {
        report((bytes += piece.byteLength));
        stream.enqueue(piece);
      },
    });
  self.fetch = async (...request) => {
    const answer = await plain(...request);
    const { status, statusText, headers } = answer;
    return answer.ok && answer.body ? new Response(answer.body.pipeThrough(counter()), { status, statusText, headers }) : answer;
  };
  return { end: () => (self.fetch = plain) };
}
