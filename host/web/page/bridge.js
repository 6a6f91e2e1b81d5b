// The page's side of the worker: requests are promises; to stop is to end the worker and start another.

/** What was stopped on purpose. */
class Stopped extends Error {}

/** What the program says of wrong input, in its own line. */
class Told extends Error {}

/** @typedef {{eps: number, boxes: number, open: number}} SoFar */

class Bridge {
  /**
   * @param {Uint8Array} packed the module
   * @param {number} size of the module when it is unpacked
   * @param {string} script of the worker
   */
  constructor(packed, size, script) {
    this.packed = packed;
    this.size = size;
    /** @type {WebAssembly.Module | null} */
    this.module = null;
    this.url = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    /** @type {Map<string, Blob>} */
    this.files = new Map();
    /** @type {Map<number, {resolve: (value: any) => void, reject: (error: Error) => void}>} */
    this.waiting = new Map();
    this.next = 1;
    /** Bytes of the module's memory after the last request. */
    this.memory = 0;
    /**
     * Is told how far a proof is.
     * @type {(so_far: SoFar) => void}
     */
    this.told = () => {};
    this.start();
  }

  start() {
    this.worker = new Worker(this.url);
    this.worker.onmessage = (event) => this.heard(event.data);
    this.worker.onerror = (event) => this.restart(new Told(`the program ended: ${event.message}`));
    const ready = this.module ? this.send({ module: this.module }) : this.send({ packed: this.packed, size: this.size });
    ready.then((module) => { this.module = module; }).catch(() => {});
    /** What the worker has of the files: names of those that it was sent. */
    this.sent = new Set();
  }

  /** @param {any} data */
  heard(data) {
    if (data.told) { this.told(data.told); return; }
    const waits = this.waiting.get(data.id);
    this.waiting.delete(data.id);
    if (data.memory) this.memory = data.memory;
    if (!waits) return;
    if (data.failed !== undefined) {
      // A trap leaves the module in no state to go on.
      const memory = /memory|allocation|unreachable/i.test(data.failed);
      const why = memory ? "the program ended: the file needs more memory than this page has, or it met a fault of its own" : data.failed;
      waits.reject(new Told(why));
      this.restart(new Stopped("started again"));
      return;
    }
    waits.resolve(data.answer);
  }

  /** @param {any} message @param {Transferable[]} [transfer] @returns {Promise<any>} */
  send(message, transfer = []) {
    const id = this.next++;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      /** @type {Worker} */ (this.worker).postMessage({ id, ...message }, transfer);
    });
  }

  /**
   * Ends what is being done; files stay.
   * @param {Error} [why]
   */
  restart(why = new Stopped("stopped")) {
    this.worker?.terminate();
    const waiting = [...this.waiting.values()];
    this.waiting.clear();
    this.start();
    for (const one of waiting) one.reject(why);
  }

  /** @param {string} name @param {Blob} blob */
  take(name, blob) {
    this.files.set(name, blob);
    this.sent?.delete(name);
  }

  /** @param {string} name */
  drop(name) {
    this.files.delete(name);
    this.sent?.clear();
    return this.send({ forget: true });
  }

  /**
   * @param {any} want what is wanted, as `request.rs` has it
   * @param {{files: string[], read: object, search: object}} [of] of which scan
   */
  async ask(want, of) {
    const worker = this.worker;
    for (const name of of?.files ?? []) {
      const blob = this.files.get(name);
      if (!blob || this.sent?.has(name)) continue;
      this.sent?.add(name);
      const bytes = await blob.arrayBuffer();
      if (worker !== this.worker) throw new Stopped("stopped");
      await this.send({ name, bytes }, [bytes]);
    }
    const answer = JSON.parse(await this.send({ request: JSON.stringify({ want, of }) }));
    if (answer.error) throw new Told(answer.error.line);
    return answer.ok;
  }
}
