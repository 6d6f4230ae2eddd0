// The page's side of the judge: it starts a worker with Python in it, asks it, and ends it where it takes too long.
//
//     const judge = new Judge({ onProgress: ({ share, says }) => ... });
//     const answer = await judge.ask({ do: "check", exercise: "7.1", student: null, answers: { K_p: "2" } });
//
// An answer is what `loopbook.exercises.forms.answer` replies. ask() rejects with an Error that holds one sentence for
// the reader. One judge is enough for a page; it loads about 25 MB the first time, so make it at the first question.

export class Judge {
  #worker;
  #waiting = []; // questions in their order; the first is with the worker
  #timer;
  #onProgress;
  library = null; // the version of the library that answers, once it is known

  /** onProgress is called with {share: 0 to 1, says: "Python, 5 of 25 MB"} while an answer waits for something to load. */
  constructor({ onProgress = () => {} } = {}) {
    this.#onProgress = onProgress;
    this.#start();
  }

  /** Ask a question, a request as `forms.answer` knows it; the promise is its reply. */
  ask(request) {
    return new Promise((resolve, reject) => {
      this.#waiting.push({ id: crypto.randomUUID?.() ?? String(Math.random()), request: JSON.stringify(request), resolve, reject });
      if (this.#waiting.length === 1) this.#send();
    });
  }

  /** End the worker for good. What waits is rejected. */
  end() {
    this.#stop();
    for (const { reject } of this.#waiting.splice(0)) reject(new Error("the page needs no answer any more"));
  }

  #start() {
    this.#worker = new Worker(new URL("judge-worker.js", import.meta.url), { type: "module" });
    this.#worker.onmessage = ({ data }) => this.#hear(data);
    this.#worker.onerror = (event) => this.#fail(event.message || "Python could not be started");
  }

  #stop() {
    clearTimeout(this.#timer);
    this.#worker?.terminate();
    this.#worker = undefined;
  }

  #send() {
    if (!this.#worker) this.#start();
    if (this.#waiting.length) {
      const { id, request } = this.#waiting[0];
      this.#worker.postMessage({ id, request });
    }
  }

  #hear({ progress, begun, limit, id, reply, failed, isDead, library }) {
    if (progress) {
      clearTimeout(this.#timer); // what loads may take its time
      if (this.#waiting.length) this.#onProgress(progress);
    } else if (begun) {
      clearTimeout(this.#timer);
      this.#timer = setTimeout(() => this.#tooSlow(limit), limit * 1000);
    } else if (library) {
      this.library = library;
    } else if (isDead) {
      console.warn(failed);
      this.#anew("Python cannot go on from this answer, and begins anew: write the answer in a simpler form");
    } else if (id) {
      this.#settle(({ resolve, reject }) => (failed ? reject(new Error(failed)) : resolve(JSON.parse(reply))));
    } else if (failed) {
      this.#fail(failed);
    }
  }

  /** The first question has its end. */
  #settle(how) {
    clearTimeout(this.#timer);
    how(this.#waiting.shift());
    if (this.#waiting.length) this.#send();
  }

  /** An answer that does not come to its end takes the worker with it; a new one begins at once, from the cache. */
  #tooSlow(limit) {
    this.#anew(`ended after ${limit} s: judging this takes too long; write the answer in a simpler form`);
  }

  #anew(says) {
    this.#stop();
    this.#start();
    this.#settle(({ reject }) => reject(new Error(says)));
  }

  /** There is no Python: all questions get to know why, and the next one tries again. */
  #fail(says) {
    this.#stop();
    for (const { reject } of this.#waiting.splice(0)) reject(new Error(says));
  }
}
