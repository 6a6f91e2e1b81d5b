// The module's side of the page: one request after the other, in a thread of its own.

/** @type {any} */
let core = null;
/** The request that is being answered. */
let asked = 0;

/** @param {Uint8Array} bytes @returns {[number, number]} address and length of a copy in the module */
function give(bytes) {
  const at = core.brdfit_take(bytes.length);
  if (at === 0) throw new Error("there is not enough memory");
  new Uint8Array(core.memory.buffer, at, bytes.length).set(bytes);
  return [at, bytes.length];
}

/** @param {any} data */
async function handle(data) {
  const { id, module, packed, size, name, bytes, request, forget } = data;
  try {
    let answer = null;
    if (packed || module) {
      let last = 0;
      // A proof has thousands of rounds a second.
      const told = (/** @type {number} */ eps, /** @type {number} */ boxes, /** @type {number} */ open) => {
        if (performance.now() < last + 100) return;
        last = performance.now();
        postMessage({ id: asked, told: { eps, boxes, open } });
      };
      // The page gets it back, for the next worker.
      answer = module ?? (await WebAssembly.compile(unpack(packed, size)));
      const instance = await WebAssembly.instantiate(answer, { page: { now: () => performance.timeOrigin + performance.now(), told } });
      core = instance.exports;
    } else if (forget) {
      core.brdfit_forget();
    } else if (bytes) {
      core.brdfit_file(...give(new TextEncoder().encode(name)), ...give(new Uint8Array(bytes)));
    } else {
      asked = id;
      const length = core.brdfit_ask(...give(new TextEncoder().encode(request)));
      answer = new TextDecoder().decode(new Uint8Array(core.memory.buffer, core.brdfit_answer(), length));
    }
    const memory = core.memory.buffer.byteLength;
    postMessage({ id, answer, memory });
  } catch (error) {
    postMessage({ id, failed: String(error) });
  }
}

// Requests wait until the module is there.
let turn = Promise.resolve();
onmessage = (event) => { turn = turn.then(() => handle(event.data)); };
