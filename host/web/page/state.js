// What the page holds, and how it does what it is asked for.

/** Files larger than this do not fit into the memory of a page. */
const LARGEST = 400e6;

/** @type {Bridge} */ let bridge;
/** @type {any} */ let about;
/** @type {Chart} */ let chart;
/** @type {Setting[]} */ let READ;
/** @type {Setting[]} */ let SEARCH;

const state = {
  /** @type {any[]} */ scans: [],
  current: 0,
  /** Places of samples of the current scan that were marked to be left out. @type {Set<number>} */ marked: new Set(),
  /** @type {{result: any, json: string, text: string, subject: any, seconds: number} | null} */ fit: null,
  /** Places of the minima that are drawn beside the best. @type {Set<number>} */ minima: new Set(),
  /** Counts what the user asked for: an answer to something older is not shown. */ turn: 0,
};

/**
 * Done when the last thing that was asked for is; tests wait for it.
 * @type {Promise<any>}
 */
let settled = Promise.resolve();

/**
 * Does something when it is asked for, and tells what goes wrong.
 * @param {() => any} act
 */
const later = (act) => () => { settled = (async () => { try { await act(); } catch (error) { tell(error); } })(); };

/** @typedef {{files: string[], read: Record<string, any>, search: Record<string, any>}} Subject */

/** Names of the files that the user gave. */
const given = () => [...bridge.files.keys()].filter((name) => !made.has(name));
/**
 * Names of files that the page made of marked samples.
 * @type {Set<string>}
 */
const made = new Set();

/** @param {unknown} error */
function tell(error) {
  if (error instanceof Stopped) return;
  $("error").textContent = error instanceof Error ? error.message : String(error);
}

/**
 * Shows that something is being done, and lets it be stopped.
 * @template T
 * @param {string} what
 * @param {() => Promise<T>} act
 * @returns {Promise<T>}
 */
async function doing(what, act) {
  const begun = performance.now();
  const clock = setInterval(() => {
    const seconds = (performance.now() - begun) / 1e3;
    if (seconds < 0.25) return;
    $("progress").hidden = false;
    $("stop").hidden = false;
    $("doing").textContent = `${doing.step || what}: ${seconds.toFixed(1)} s`;
  }, 100);
  try {
    const done = await act();
    const seconds = (performance.now() - begun) / 1e3;
    $("doing").textContent = `${what}: done in ${seconds < 1 ? `${Math.round(1e3 * seconds)} ms` : `${seconds.toFixed(1)} s`}; ${Math.round(bridge.memory / 2 ** 20)} MB`;
    return done;
  } catch (error) {
    $("doing").textContent = error instanceof Stopped ? `${what}: stopped` : `${what}: not done`;
    throw error;
  } finally {
    clearInterval(clock);
    doing.step = "";
    $("progress").hidden = true;
    $("progress").removeAttribute("value");
    $("stop").hidden = true;
  }
}
/** A step of what is being done. */
doing.step = "";

/**
 * How far it is.
 * @param {string} step
 * @param {number} part
 */
function progress(step, part) {
  doing.step = step;
  $("progress").value = part;
}
