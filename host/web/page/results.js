// What was read and what was found, as elements.

/**
 * What was read of a scan.
 * @param {any} scan
 * @returns {Node[]}
 */
function readView(scan) {
  const { inspect } = scan;
  const columns = inspect.columns.map((/** @type {any} */ one) => `${one.number} ${one.name}: ${one.holds}`).join("; ");
  /** @type {Map<string, number>} */
  const reasons = new Map();
  for (const one of inspect.left_out) reasons.set(one.reason, (reasons.get(one.reason) ?? 0) + one.samples);
  const angles = inspect.angles.map((/** @type {any} */ one) => digits(one.theta_i_deg, 5));
  const shown = angles.length > 12 ? [...angles.slice(0, 12), `and ${angles.length - 12} more`] : angles;
  /** @type {[string, string][]} */
  const rows = [
    ["Read as", scan.read_as],
    ["Columns", columns],
    ["Not used", inspect.not_used.join(", ")],
    ["Samples", `${inspect.samples} at incidence ${shown.join(", ")}°`],
    ["Weights", inspect.sigma_ln === null ? "" : `of standard deviations, ${digits(100 * inspect.sigma_ln, 3)} % at a weight of 1`],
    ["Left out", [...reasons].map(([reason, count]) => `${count} ${reason.replaceAll("_", " ")}`).join(", ")],
  ];
  const list = rows.filter(([, text]) => text !== "").flatMap(([name, text]) => [h("dt", {}, name), h("dd", {}, text)]);
  return [
    h("dl", {}, ...list),
    ...inspect.notes.map((/** @type {string} */ note) => h("p", { class: "note text" }, note)),
    ...inspect.hints.map((/** @type {any} */ hint) => h("p", { class: "hint text" }, hint.text)),
  ];
}

/**
 * The fit's parameters.
 * @param {any} result
 * @param {any} model
 * @param {number} seconds
 * @returns {Node[]}
 */
function parametersView(result, model, seconds) {
  const known = result.uncertainty;
  const open = new Set(known.undetermined.flatMap((/** @type {any} */ one) => one.parameters));
  const rows = model.parameters.filter((/** @type {any} */ one) => known.stderr[one.name] !== undefined || result.parameters[one.name] !== 0).map((/** @type {any} */ one) => {
    const bounds = result.provenance.bounds[one.name];
    const fixed = bounds[0] === bounds[1];
    const remark = fixed ? "fixed" : result.at_bound.includes(one.name) ? "on a bound" : open.has(one.name) ? "not determined alone" : "";
    const error = known.stderr[one.name];
    return h("tr", {},
      h("th", { scope: "row", class: "word" }, one.name), h("td", {}, digits(result.parameters[one.name])),
      h("td", {}, error ? `± ${digits(error, 2)}` : "–"), h("td", {}, `${digits(bounds[0], 4)} – ${digits(bounds[1], 4)}`),
      h("td", { class: "remark" }, [one.what + (one.unit ? `, ${one.unit}` : ""), remark].filter(Boolean).join("; ")));
  });
  const sentences = [
    `${result.model}: ${result.samples} samples, rms residual of ln f ${digits(100 * result.rms_ln, 4)} %, MSE² ${digits(result.mse2, 5)}${result.chi2 === undefined || result.chi2 === null ? "" : `, χ² ${digits(result.chi2, 5)} of ${known.degrees_of_freedom} degrees of freedom`}; ${digits(1e3 * seconds, 3)} ms.`,
  ];
  const flags = [
    ...known.undetermined.map((/** @type {any} */ one) => `${one.through.length ? "The scan tells of " : ""}${one.sentence}.`),
    ...(result.hints ?? []).map((/** @type {any} */ one) => one.text),
  ];
  if (result.derived.some((/** @type {any} */ one) => one.energy_conserved === false)) flags.push("At some angle of incidence the fitted reflectance is above 1: the model does not conserve energy there.");
  return [
    h("p", { id: "summary" }, ...sentences),
    ...flags.map((text) => h("p", { class: "hint text" }, text)),
    table([["parameter", "word"], ["value"], ["± one standard error"], ["bounds"], ["meaning", "word"]], rows, "Parameters of the best fit"),
  ];
}

/**
 * Distinct minima; each can be drawn.
 * @param {any} result @param {any} model @param {Set<number>} drawn @param {(place: number) => void} toggle @returns {Node[]}
 */
function minimaView(result, model, drawn, toggle) {
  const names = model.parameters.map((/** @type {any} */ one) => one.name);
  const rows = result.minima.slice(0, 24).map((/** @type {any} */ one, /** @type {number} */ place) =>
    h("tr", { class: drawn.has(place) ? "chosen" : null },
      h("td", { class: "word" }, place === 0 ? "best" : h("button", { type: "button", class: "small", "aria-pressed": drawn.has(place), onclick: () => toggle(place) }, `draw ${place + 1}`)),
      h("td", {}, digits(one.mse2, 5)), ...names.map((/** @type {string} */ name) => h("td", {}, digits(one.parameters[name], 5))), h("td", {}, String(one.hits))));
  const more = result.minima.length > 24 ? ` The best 24 of ${result.minima.length} are listed.` : "";
  return [
    h("p", { class: "note" }, `${result.minima.length === 1 ? "Every fit that converged ended in one minimum." : `${result.minima.length} minima; those drawn are dashed.`}${more}`),
    table([["minimum", "word"], ["MSE²"], ...names.map((/** @type {string} */ name) => /** @type {[string]} */ ([name])), ["hits"]], rows, "Distinct minima, best first"),
  ];
}

/**
 * All scans with their fits.
 * @param {{label: string, result: any}[]} all
 * @param {(place: number) => void} show
 * @returns {Node[]}
 */
function allView(all, show) {
  const names = [...new Set(all.flatMap((one) => Object.keys(one.result.parameters)))];
  const rows = all.map((one, place) => h("tr", {},
    h("td", { class: "word" }, h("button", { type: "button", class: "small", onclick: () => show(place) }, one.label)), h("td", { class: "word" }, one.result.model),
    h("td", {}, String(one.result.samples)), h("td", {}, digits(100 * one.result.rms_ln, 4)), ...names.map((name) => h("td", {}, digits(one.result.parameters[name])))));
  return [table([["scan", "word"], ["model", "word"], ["samples"], ["rms, %"], ...names.map((name) => /** @type {[string]} */ ([name]))], rows, "Fits of all scans")];
}
