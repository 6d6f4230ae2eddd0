// Python in a worker, shared by all pages where the browser can: it loads what an answer needs, part by part, and answers.
//
// wheels/parts.json says what there is (docs/browser/site.py writes it): {version, pyodide, parts: {name: {says, files:
// [{url, bytes, sha256}]}}, later: {package: part}}. The part "python" comes first, others when an exercise needs them.
// What came once is kept in the browser's Cache storage, where the page's address allows that (https or localhost).
//
// Messages from a page: {id, request}, and {end} from one that has left this Python. To all pages: {progress: {share,
// says}}, {begun: id, limit}, {id, reply} or {id, failed}, {library}, its version, once it is there, and {isGone}, at the
// end of this Python, with {failed} where another one would be no better. Requests and replies are texts of JSON.

const SITE = new URL("..", self.location);
const PARTS = new URL("wheels/parts.json", SITE);
const FIRST = "python";
const KEPT = `loopbook parts ${SITE}`;
const PACKAGES = "/lib/python3.12/site-packages";
const LIBRARY = "python_stdlib.zip";
const MEGABYTE = 1e6;

/** Seconds that may pass on a usual computer: until the key of an exercise is computed, and until an answer is judged. */
const LIMIT = { prepare: 60, check: 3, typeset: 10 };

/** Seconds after which a download of which nothing more comes is given up. */
const PATIENCE = 30;

/** After so many milliseconds without a question there is time to keep what Python has compiled. */
const REST = 1000;

/** Progress: the first part of the way is the download, the rest is what Python does with it. */
const DOWNLOADED = 0.6;

const pages = new Set(); // their ports

function tell(message) {
  for (const page of pages) page.postMessage(message);
}

function progress(share, says) {
  tell({ progress: { share, says } });
}

/** Ends an answer without end: Python looks here for a signal again and again. */
const clock = {
  end: Infinity,
  hasRung: false,
  begin(seconds) {
    Object.assign(this, { end: performance.now() + seconds * 1000, hasRung: false });
  },
  get 0() {
    if (performance.now() < this.end) return 0;
    Object.assign(this, { end: performance.now() + 1000, hasRung: true }); // once more where nobody hears it
    return 2; // SIGINT
  },
  set 0(_) {}, // Python takes a signal away that it has seen
};

/** What this browser keeps of the site, or nothing where it keeps nothing: caches exist on https and localhost only. */
class Kept {
  static async opened(parts) {
    const cache = await self.caches?.open(KEPT).catch(() => undefined);
    return new Kept(cache, parts);
  }

  constructor(cache, parts) {
    this.cache = cache;
    this.version = parts.version;
    this.wanted = new Set([PARTS.href]);
    for (const { files } of Object.values(parts.parts)) for (const { url } of files) this.wanted.add(address(url));
  }

  async get(url) {
    const response = await this.cache?.match(url).catch(() => undefined);
    return response && new Uint8Array(await response.arrayBuffer());
  }

  async put(url, bytes) {
    await this.cache?.put(url, new Response(bytes)).catch(() => undefined); // a full disk only makes the next visit slow
  }

  /** The address under which something is kept that an earlier visit compiled; a new site has compiled nothing. */
  compiled(name) {
    return new URL(`compiled/${this.version}/${name}`, PARTS).href;
  }

  /** Throw away what belongs to an earlier state of the site. */
  async tidy() {
    for (const { url } of (await this.cache?.keys()) ?? []) {
      if (!this.wanted.has(url) && !url.startsWith(this.compiled(""))) await this.cache.delete(url);
    }
  }
}

function address(url) {
  return new URL(url, PARTS).href;
}

/** The file's name in an address: what Pyodide asks for by another address is known by it. */
function nameOf(url) {
  return new URL(url, PARTS).pathname.split("/").pop();
}

/** A file that cannot be had now; Python is none the worse for it. */
class Missing extends Error {}

/** An answer that does not come to its end; Python is none the worse for that either. */
class TooSlow extends Error {
  constructor(seconds) {
    super(`ended after ${seconds} s: judging this takes too long; write the answer in a simpler form`);
  }
}

/** Loads files of parts, and tells how far it is. */
class Loader {
  constructor(kept) {
    this.kept = kept;
    this.files = new Map(); // name -> Uint8Array
  }

  /** Load all files of a part at once. */
  async load(part, from, to) {
    const whole = part.files.reduce((sum, file) => sum + file.bytes, 0);
    let arrived = 0;
    const more = (bytes) => {
      arrived += bytes;
      const so = `${(arrived / MEGABYTE).toFixed(0)} of ${(whole / MEGABYTE).toFixed(0)} MB`;
      progress(from + ((to - from) * arrived) / whole, `${part.says}, ${so}`);
    };
    await Promise.all(part.files.map(async (file) => this.files.set(nameOf(file.url), await this.file(file, more))));
  }

  async file({ url, bytes, sha256 }, more) {
    const kept = await this.kept.get(address(url));
    // another version of the site may have kept another file at this address, and a disk may fail
    if (kept && (await isAsExpected(kept, sha256))) {
      more(bytes);
      return kept;
    }
    const fetched = await download(url, more);
    if (!(await isAsExpected(fetched, sha256))) {
      throw new Missing(`${nameOf(url)} is not the file that was expected: reload the page, or tell whoever runs the site`);
    }
    await this.kept.put(address(url), fetched);
    return fetched;
  }

  /** Take a file that is loaded; it is not needed twice. */
  take(name) {
    const bytes = this.files.get(name);
    this.files.delete(name);
    return bytes;
  }
}

async function download(url, more) {
  const stalled = new AbortController();
  let timer;
  const wait = () => {
    clearTimeout(timer);
    timer = setTimeout(() => stalled.abort(new Error(`nothing came for ${PATIENCE} s`)), PATIENCE * 1000);
  };
  try {
    wait();
    const response = await fetch(address(url), { signal: stalled.signal });
    if (!response.ok) throw new Error(response.status);
    const pieces = [];
    for (let reader = response.body.getReader(); ; ) {
      const { done, value } = await reader.read();
      if (done) return new Uint8Array(await new Blob(pieces).arrayBuffer());
      pieces.push(value);
      more(value.length);
      wait();
    }
  } catch (error) {
    const { host } = new URL(url, PARTS);
    throw new Missing(`${nameOf(url)} could not be loaded from ${host} (${error.message}): is there a network?`);
  } finally {
    clearTimeout(timer);
  }
}

async function isAsExpected(bytes, sha256) {
  if (!self.crypto?.subtle) return true; // plain http has no hashes; the other checks of a download are TCP's
  const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", bytes));
  return [...digest].map((byte) => byte.toString(16).padStart(2, "0")).join("") === sha256;
}

/** Run a JavaScript module that was loaded as bytes. */
async function imported(bytes) {
  const url = URL.createObjectURL(new Blob([bytes], { type: "text/javascript" }));
  try {
    return await import(url);
  } finally {
    URL.revokeObjectURL(url);
  }
}

/** Pyodide fetches its parts by itself: it gets those that are loaded. */
function serveLoaded(loader) {
  const network = self.fetch;
  self.fetch = (resource, options) => {
    const name = nameOf(resource.url ?? resource);
    const bytes = loader.take(name);
    if (!bytes) return network(resource, options);
    const type = name.endsWith(".wasm") ? "application/wasm" : "application/octet-stream";
    return Promise.resolve(new Response(bytes, { headers: { "Content-Type": type } }));
  };
}

/** Python with the parts of it that are loaded, and the judge in it. */
class Python {
  static async started() {
    progress(0, "Python");
    const parts = await listed();
    const python = new Python(parts, await Kept.opened(parts));
    await python.start();
    return python;
  }

  constructor(parts, kept) {
    this.parts = parts;
    this.kept = kept;
    this.loader = new Loader(kept);
  }

  async start() {
    await this.loader.load(this.parts.parts[FIRST], 0, DOWNLOADED);
    progress(DOWNLOADED, "Python starts");
    const library = await this.kept.get(this.kept.compiled(LIBRARY));
    if (library) this.loader.files.set(LIBRARY, library);
    await imported(this.loader.take("pyodide.asm.js"));
    const { loadPyodide } = await imported(this.loader.take("pyodide.mjs"));
    serveLoaded(this.loader);
    this.pyodide = await loadPyodide({
      indexURL: new URL(".", PARTS).href,
      env: { HOME: "/home", MPLBACKEND: "agg", MPLCONFIGDIR: `${PACKAGES}/fonts` }, // kept with the packages
      stdout: console.debug,
      stderr: console.debug, // warnings of packages are not for readers
    });
    this.PythonError = this.pyodide.ffi.PythonError; // a Python that has ended cannot be asked for it
    progress(0.75, "Python reads the packages");
    await this.unpack(this.parts.parts[FIRST]);
    const module = this.pyodide.toPy({});
    this.pyodide.runPython(new TextDecoder().decode(this.loader.take("judge.py")), { globals: module });
    this.judge = module.get("Judge")(this.pyodide.toPy(this.parts.later), PACKAGES);
    for (this.batches = 0; ; this.batches += 1) {
      const batch = await this.kept.get(this.kept.compiled(this.batches));
      if (!batch) break;
      this.judge.restore(this.pyodide.toPy(batch));
    }
    progress(0.8, this.batches ? "Python remembers the exercises" : "Python reads the exercises for the first time");
    this.judge.begin();
    this.pyodide.setInterruptBuffer(clock);
    await this.kept.tidy();
  }

  /** Unpack the wheels of a part; a shared library is loaded as Pyodide does it. */
  async unpack({ files }) {
    for (const { url } of files) {
      const name = nameOf(url);
      if (name.endsWith(".whl")) {
        this.pyodide.unpackArchive(this.loader.take(name), "wheel", { extractDir: PACKAGES });
      } else if (name.endsWith(".zip") && this.loader.files.has(name)) {
        await this.pyodide.loadPackage(name.split("-")[0], { messageCallback() {} });
      }
    }
  }

  async fetch(name) {
    const part = this.parts.parts[name];
    await this.loader.load(part, 0, 0.9);
    progress(0.9, `Python reads ${part.says}`);
    await this.unpack(part);
    this.judge.later.arrived(name);
  }

  /** Call a function of the judge until it lacks no part; on a slow device that may take longer. */
  async within(seconds, id, call, slowness = () => this.judge.slowness()) {
    for (;;) {
      const limit = Math.round(seconds * slowness());
      tell({ begun: id, limit });
      clock.begin(limit);
      try {
        const [reply, lacks] = call();
        if (!lacks) return reply;
        clock.end = Infinity;
        await this.fetch(lacks);
      } catch (error) {
        throw clock.hasRung ? new TooSlow(limit) : error;
      } finally {
        clock.end = Infinity;
      }
    }
  }

  async answer(id, request) {
    const { do: what } = JSON.parse(request);
    const isTyping = what === "typeset"; // then there is no key, and no time to measure how slow it is here
    if (!isTyping) await this.within(LIMIT.prepare, id, () => ["", this.judge.prepare(request)]);
    const reply = () => {
      const found = this.judge.reply(request);
      try {
        return found.toJs();
      } finally {
        found.destroy();
      }
    };
    return this.within(LIMIT[what] ?? LIMIT.prepare, id, reply, isTyping ? () => 1 : undefined);
  }

  /** Keep what Python has compiled, little by little, until it is all kept or `isWanted` says that there is a question. */
  async keepCompiled(isWanted) {
    while (this.kept.cache && !isWanted()) {
      const ready = this.judge.compile();
      if (ready === "nothing") return;
      if (ready === "packages") await this.keep(this.batches++, ready);
      if (ready === "standard library") await this.keep(LIBRARY, ready);
      await new Promise((resolve) => setTimeout(resolve)); // lets a question in
    }
  }

  async keep(name, archive) {
    const bytes = this.judge.take(archive);
    await this.kept.put(this.kept.compiled(name), bytes.toJs());
    bytes.destroy();
  }
}

/** The list of the parts: the newest one, and without a network the last one. */
async function listed() {
  const cache = await self.caches?.open(KEPT).catch(() => undefined);
  try {
    const response = await fetch(PARTS, { cache: "no-cache" });
    if (!response.ok) throw new Error(response.status);
    const copy = response.clone();
    const parts = await response.json(); // what is none, as the page of a network that asks to log in, is not kept
    await cache?.put(PARTS, copy).catch(() => undefined);
    return parts;
  } catch (error) {
    const kept = await cache?.match(PARTS);
    if (kept) return kept.json();
    throw new Error(`the list of Python's parts could not be loaded (${error.message}): is there a network?`);
  }
}

let started; // Python, once somebody has asked for it
let rest; // the timer until it keeps what it has compiled
let questions = 0;
let queue = Promise.resolve();

async function answer({ id, request }) {
  started ??= Python.started();
  const python = await started.catch(({ message }) => end(message));
  if (!python) return;
  tell({ library: python.parts.library });
  try {
    tell({ id, reply: await python.answer(id, request) });
  } catch (error) {
    const lives = [python.PythonError, Missing, TooSlow].some((kind) => error instanceof kind);
    const says = "Python cannot go on from this answer, and begins anew: write the answer in a simpler form";
    tell({ id, failed: lives ? error.message : says });
    if (!lives) end(); // as after an overflow of the stack below it
  }
  questions -= 1;
  clearTimeout(rest);
  rest = setTimeout(() => python.keepCompiled(() => questions > 0), REST);
}

function end(failed) {
  tell({ isGone: true, failed });
  self.close();
}

function join(page) {
  pages.add(page);
  page.onmessage = ({ data }) => {
    if (data.end) return end();
    questions += 1;
    queue = queue.then(() => answer(data));
  };
  started?.then(({ parts }) => page.postMessage({ library: parts.library }), () => {});
}

if ("onconnect" in self) self.onconnect = ({ ports }) => join(ports[0]);
else join(self);
