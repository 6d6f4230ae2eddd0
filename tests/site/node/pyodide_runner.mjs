// Starts Pyodide in node and runs a program of Python in it.
//
//     node pyodide_runner.mjs ORDER.json
//
// The order says where Pyodide's parts are, which of its packages are installed, which folders of this machine Python
// sees under which names, and the program.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const order = JSON.parse(readFileSync(process.argv[2], "utf8"));

async function run() {
  const { loadPyodide } = await import(pathToFileURL(`${order.parts}/pyodide.mjs`));
  const python = await loadPyodide({ indexURL: `${order.parts}/`, env: order.environment });
  const quiet = { messageCallback: () => {}, errorCallback: (says) => console.error(says) };
  await python.loadPackage(order.packages, quiet);
  for (const [name, root] of Object.entries(order.folders)) {
    python.FS.mkdirTree(name);
    python.FS.mount(python.FS.filesystems.NODEFS, { root }, name);
  }
  await python.runPythonAsync(order.program);
}

try {
  await run();
} catch (error) {
  console.error(error.stack ?? error.message ?? error); // without the megabyte of Pyodide's code that node would show
  process.exit(1);
}
process.exit(0); // what Python has left behind keeps nobody waiting
