// The page's side of the judge: it asks a worker with Python in it, and leaves one that takes too long.
//
//     const judge = new Judge({ version, onProgress: ({ share, says }) => ... });
//     const answer = await judge.ask({ do: "check", exercise: "7.1", student: null, answers: { K_p: "2" } });
//
// An answer is what `loopbook.exercises.forms.answer` replies. ask() rejects with an Error that holds one sentence for
// the reader. One judge is enough for a page. All pages share one Python, which stays while the reader goes from page to
// page; a browser without shared workers has one for each page. About 25 MB are loaded at the first question.

const KEY = "loopbook python"; // in the browser's storage: how many Pythons had to be left
const SILENCE = 120; // seconds without a sign of life after which Python is left
const GRACE = 3; // seconds that Python may need to end an answer by itself, which keeps it alive

function left(number = 0) {
  try {
    if (number > Number(localStorage.getItem(KEY))) localStorage.setItem(KEY, number);
    return Number(localStorage.getItem(KEY));
  } catch {
    return number; // a browser that keeps nothing
  }
}

export class Judge {
  #port; // of the worker, or a worker of our own
  #number = 0; // of that worker
  #waiting = []; // questions in their order; the first is with the worker
  #begun; // the id of the question that Python is at, which may be another page's
  #timer;
  #version;
  #onProgress;
  library = null; // the version of the library that answers, once it is known

  /** version is that of the page; onProgress is called with {share: 0 to 1, says: "Python, 5 of 25 MB"} while it loads. */
  constructor({ version = "", onProgress = () => {} } = {}) {
    this.#version = version;
    this.#onProgress = onProgress;
    this.#connect();
    addEventListener("pageshow", ({ persisted }) => persisted && this.#connect()); // it may have gone meanwhile
  }

  /** Ask a question, a request as `forms.answer` knows it; the promise is its reply. */
  ask(request) {
    return new Promise((resolve, reject) => {
      this.#waiting.push({ id: crypto.randomUUID?.() ?? String(Math.random()), request: JSON.stringify(request), resolve, reject });
      if (this.#waiting.length === 1) this.#send();
    });
  }

  #connect() {
    const script = new URL("judge-worker.js", import.meta.url);
    this.#number = Math.max(this.#number, left());
    const name = `${this.#version} ${this.#number}`;
    const isShared = "SharedWorker" in window;
    const worker = isShared
      ? new SharedWorker(script, { type: "module", name, extendedLifetime: true })
      : new Worker(script, { type: "module" });
    worker.onerror = ({ message }) => this.#leave(message || "Python could not be started");
    this.#port = isShared ? worker.port : worker;
    this.#port.onmessage = ({ data }) => this.#hear(data);
    if (this.#waiting.length) this.#send();
  }

  #send() {
    if (this.#number < left()) return this.#connect(); // another page has left this Python
    const { id, request } = this.#waiting[0];
    this.#port.postMessage({ id, request });
    this.#wait(SILENCE);
  }

  #wait(seconds) {
    clearTimeout(this.#timer);
    if (this.#waiting.length) this.#timer = setTimeout(() => this.#tooSlow(seconds), seconds * 1000);
  }

  #hear({ progress, begun, limit, id, reply, failed, isGone, library }) {
    this.#wait(begun ? limit + GRACE : SILENCE); // what loads may take its time
    if (progress) {
      if (this.#waiting.length) this.#onProgress(progress);
    } else if (begun) {
      this.#begun = begun;
    } else if (library) {
      this.library = library;
    } else if (isGone) {
      this.#leave(failed);
    } else if (id === this.#waiting[0]?.id) {
      this.#settle(({ resolve, reject }) => (failed ? reject(new Error(failed)) : resolve(JSON.parse(reply))));
    }
  }

  /** The first question has its end. */
  #settle(how) {
    clearTimeout(this.#timer);
    how(this.#waiting.shift());
    if (this.#waiting.length) this.#send();
  }

  /** Python is at what it cannot end: whoever asked that has no answer, and the others ask a new Python, from the cache. */
  #tooSlow(seconds) {
    if (this.#begun === this.#waiting[0].id) {
      const says = `ended after ${seconds} s: judging this takes too long; write the answer in a simpler form`;
      this.#waiting.shift().reject(new Error(says));
    }
    this.#leave();
  }

  /** This Python is of no use any more, to no page; what waits asks the next one, or gets to know why there is none. */
  #leave(why) {
    clearTimeout(this.#timer);
    left(++this.#number);
    this.#port.postMessage({ end: true });
    this.#port.terminate?.();
    this.library = null;
    if (why) for (const { reject } of this.#waiting.splice(0)) reject(new Error(why));
    this.#connect();
  }
}
