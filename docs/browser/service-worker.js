// What a reader has visited stays readable without a network.
//
// The site's builder puts the hash of the whole site in the place of VERSION (docs/browser/site.py). A new site so has
// another service worker, which takes the place of this one at once and throws away what it kept.

const VERSION = "VERSION";
const SCOPE = self.registration.scope;
const KEPT = `loopbook pages ${SCOPE} ${VERSION}`;
/** What others keep: the judge its parts, JupyterLite its own pages. */
const OTHERS = ["wheels/", "runtime/", "lite/"].map((folder) => new URL(folder, SCOPE).href);
/** Pictures and fonts come from the cache first. Of pages and scripts the newest counts, if it comes in time (ms). */
const LASTING = /\.(png|svg|jpe?g|webp|gif|woff2?)$/;
const IN_TIME = 4000;
/** The front page, and what a page asks for only when an exercise is answered. */
const ALWAYS = ["", "index.html", "_static/judge.js", "_static/judge-worker.js"].map((file) => new URL(file, SCOPE).href);

self.addEventListener("install", (event) => {
  self.skipWaiting();
  event.waitUntil(keep(ALWAYS));
});

self.addEventListener("activate", (event) => event.waitUntil(takeOver()));

self.addEventListener("message", (event) => event.waitUntil(keep(event.data.visited)));

self.addEventListener("fetch", (event) => {
  const { method, url } = event.request;
  if (method !== "GET" || !isOurs(url)) return;
  const lasting = LASTING.test(new URL(url).pathname);
  event.respondWith(lasting ? cacheFirst(event) : networkFirst(event));
});

function isOurs(url) {
  return url.startsWith(SCOPE) && !OTHERS.some((folder) => url.startsWith(folder));
}

async function takeOver() {
  const ours = (name) => name.startsWith(`loopbook pages ${SCOPE} `) && name !== KEPT;
  await Promise.all((await caches.keys()).filter(ours).map((name) => caches.delete(name)));
  await self.clients.claim();
}

/** Keep what the first visit has loaded while there was no service worker. */
async function keep(urls) {
  const cache = await caches.open(KEPT);
  for (const url of urls.filter(isOurs)) {
    if (await cache.match(url)) continue;
    const response = await fetch(url).catch(() => undefined);
    if (response?.ok) await keepAnew(url, response).catch(() => undefined);
  }
}

async function cacheFirst(event) {
  return (await kept(event.request)) ?? fetched(event);
}

async function networkFirst(event) {
  const response = fetched(event);
  const late = new Promise((resolve) => setTimeout(resolve, IN_TIME));
  try {
    return (await Promise.race([response, late])) ?? (await kept(event.request)) ?? (await response);
  } catch (error) {
    const old = await kept(event.request);
    if (old) return old;
    if (event.request.mode === "navigate") return notVisited();
    throw error;
  }
}

async function fetched(event) {
  const response = await fetch(event.request);
  if (response.ok && response.type === "basic" && !response.redirected) {
    event.waitUntil(keepAnew(event.request, response.clone()).catch(() => undefined));
  }
  return response;
}

/** Keep what came, unless it is a page that is none of the site's: that of a network which asks to log in. */
async function keepAnew(request, response) {
  const isPage = response.headers.get("Content-Type")?.includes("html");
  if (isPage && !(await response.clone().text()).includes("_static/offline.js")) return;
  await (await caches.open(KEPT)).put(request, response);
}

async function kept(request) {
  const cache = await caches.open(KEPT);
  return (await cache.match(request)) ?? cache.match(request, { ignoreSearch: true });
}

/** The page instead of one that was never visited and cannot be fetched: a list of those that were. */
async function notVisited() {
  const requests = await (await caches.open(KEPT)).keys();
  const addresses = requests.map(({ url }) => url.split(/[?#]/)[0].replace(/\/index\.html$/, "/"));
  const pages = new Set(addresses.filter((url) => /(\/|\.html)$/.test(url)));
  const links = [...pages].map((url) => `<li><a href="${url}">${url.slice(SCOPE.length) || "The front page"}</a>`);
  const body = `<!doctype html><html lang="en"><meta charset="utf-8"><title>No network</title>
    <meta name="viewport" content="width=device-width"><meta name="color-scheme" content="light dark">
    <body style="font: 1.1em/1.5 sans-serif; max-width: 40em; margin: 2em auto; padding: 0 1em"><h1>No network</h1>
    <p>This page was not visited so far, so it is not kept here. These are:<ul>${links.join("")}</ul>`;
  return new Response(body, { status: 503, headers: { "Content-Type": "text/html; charset=utf-8" } });
}
