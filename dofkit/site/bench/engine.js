// The worker from a page's point of view: questions are asked, answers come, and what takes too long is replaced.

/** @typedef {{resolve: (value: any) => void, reject: (error: Error) => void}} Asked */

/** The answer of a worker that was replaced before it came. */
export class Stopped extends Error {}

export class Engine {
  /** @param {(state: "loading" | "ready") => void} changed is called when the worker is ready, or loads anew */
  constructor(changed) {
    this.changed = changed;
    /** @type {Map<number, Asked>} */
    this.asked = new Map();
    this.next = 0;
    /** @type {number | undefined} since when Python runs for a question */
    this.since = undefined;
    this.start();
  }

  start() {
    this.changed("loading");
    this.worker = new Worker(new URL("./runtime/worker.js", import.meta.url), { type: "module" });
    this.worker.addEventListener("message", ({ data }) => this.hear(data));
    this.worker.addEventListener("error", (event) => this.fail(event.message || "the worker could not be started"));
  }

  hear({ id, value, error, state }) {
    if (state) {
      this.since = state === "running" ? performance.now() : undefined;
      if (state === "ready") this.changed("ready");
      return;
    }
    const asked = this.asked.get(id);
    if (!asked) return;
    this.asked.delete(id);
    if (error) asked.reject(new Error(error));
    else asked.resolve(value);
  }

  /** @param {string} call @param {...any} args @returns {Promise<any>} */
  ask(call, ...args) {
    return new Promise((resolve, reject) => {
      const id = this.next++;
      this.asked.set(id, { resolve, reject });
      this.worker.postMessage({ id, call, args });
    });
  }

  /** Milliseconds for which Python has run for one question; what is loaded for it does not count. */
  get busy() {
    return this.since === undefined ? 0 : performance.now() - this.since;
  }

  /** End what is running, and start another worker. */
  replace() {
    this.worker.terminate();
    this.since = undefined;
    this.fail("stopped", Stopped);
    this.start();
  }

  fail(reason, kind = Error) {
    const waiting = [...this.asked.values()];
    this.asked.clear();
    for (const { reject } of waiting) reject(new kind(reason));
  }
}
