// The service worker of the notebooks in the page: JupyterLite's own, which shows Python the reader's files, and a store
// of what was fetched, so that a chapter that was run once runs without a network.

const MADE = "VERSION"; // of this JupyterLite: docs/browser/lite.py writes it, so that a browser sees a new worker
const SITE = new URL("..", self.registration.scope).href;
const STORE = `loopbook notebooks ${SITE}`;
const JUPYTERLITES_OWN = /\/api\/(drive|stdin\/|service-worker-heartbeat)/;

self.addEventListener("fetch", (event) => {
  const { request } = event;
  const { origin, pathname, protocol } = new URL(request.url);
  if (request.method !== "GET" || !protocol.startsWith("http") || JUPYTERLITES_OWN.test(pathname)) return;
  event.stopImmediatePropagation();
  // what lies with Pyodide never changes under its address; what is the site's may
  event.respondWith(origin === location.origin ? freshFirst(request) : storedFirst(request));
});

// A new worker means a new site: what was stored of the old one goes.
self.addEventListener("activate", (event) => event.waitUntil(forget()));

async function forget() {
  const store = await caches.open(STORE);
  const ofTheSite = (await store.keys()).filter(({ url }) => url.startsWith(SITE));
  await Promise.all(ofTheSite.map((request) => store.delete(request)));
  console.info(`The notebooks are those of ${MADE}.`);
}

async function storedFirst(request) {
  const stored = await caches.match(request); // whoever stored it: the exercises of the site need much of it, too
  return stored ? typed(request, stored) : kept(await caches.open(STORE), request, await fetch(request));
}

// What the exercises store has no type, without which nothing is a program.
function typed({ url }, stored) {
  const type = { js: "text/javascript", mjs: "text/javascript", wasm: "application/wasm" }[url.split(".").pop()];
  return type ? new Response(stored.body, { headers: { "Content-Type": type } }) : stored;
}

async function freshFirst(request) {
  const store = await caches.open(STORE);
  try {
    return await kept(store, request, await fetch(request));
  } catch (problem) {
    const stored = await store.match(request, { ignoreSearch: true });
    if (!stored) throw problem;
    return stored;
  }
}

// Store an answer, unless the very same is stored already.
async function kept(store, request, answer) {
  if (answer.status !== 200) return answer;
  const stored = await store.match(request);
  const mark = ({ headers }) => headers.get("etag") ?? `${headers.get("last-modified")} ${headers.get("content-length")}`;
  if (!stored || mark(stored) !== mark(answer)) await store.put(request, answer.clone());
  return answer;
}

importScripts("jupyterlite-service-worker.js");
