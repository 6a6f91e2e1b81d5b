// The page as a whole: all scans at once, files that are given, and its beginning.

/** Fits every scan; what is done stays when it is stopped. */
async function fitAll() {
  const turn = ++state.turn;
  $("error").textContent = "";
  /** @type {{label: string, result: any, json: string, place: number}[]} */
  const all = [];
  /** @type {string[]} */
  const failed = [];
  const before = state.current;
  try {
    await doing("Fits of all scans", async () => {
      for (let place = 0; place < state.scans.length; place++) {
        progress(`Scan ${place + 1} of ${state.scans.length}`, place / state.scans.length);
        state.current = place;
        const of = subject();
        state.current = before;
        try {
          const answer = await bridge.ask("fit", of);
          all.push({ label: state.scans[place].label, json: answer.json, result: JSON.parse(answer.json), place });
        } catch (error) {
          if (!(error instanceof Told)) throw error;
          failed.push(error.message);
        }
        if (turn !== state.turn) throw new Stopped("stopped");
      }
    });
  } catch (error) { tell(error); }
  $("all").hidden = all.length === 0;
  $("all-table").replaceChildren(...allView(all, (row) => { state.current = all[row].place; $("scan").value = String(state.current); state.marked.clear(); showScan(); later(changedFit)(); }),
    h("div", { class: "row" }, h("button", { type: "button", onclick: () => save("fits.json", `[\n${all.map((one) => one.json.trimEnd().replace(/^/gm, "  ")).join(",\n")}\n]\n`, "application/json") }, "JSON of all"),
      h("span", { class: "note" }, `${all.length} of ${state.scans.length} scans are fitted.`)),
    ...failed.map((text) => h("p", { class: "hint text" }, text)));
}

/**
 * Takes files that were dropped or chosen.
 * @param {Iterable<File>} files
 */
async function take(files) {
  for (const file of files) {
    if (file.size > LARGEST) { tell(new Told(`${file.name} has ${size(file.size)}, and this page takes up to ${size(LARGEST)}; the program takes more`)); return; }
    bridge.take(file.name, file);
  }
  await readAll();
}

/** Buttons above the figure. */
function bar() {
  const button = (/** @type {string} */ text, /** @type {string} */ title, /** @type {() => void} */ act) => h("button", { type: "button", class: "small", title, onclick: act }, text);
  const log = button("Log axis", "Logarithmic or linear", () => { chart.log = !chart.log; log.setAttribute("aria-pressed", chart.log); chart.reset(); });
  const marks = button("Mark", "Drag over samples to leave them out", () => { chart.mode = chart.mode === "zoom" ? "mark" : "zoom"; marks.setAttribute("aria-pressed", chart.mode === "mark"); });
  log.setAttribute("aria-pressed", "true");
  marks.setAttribute("aria-pressed", "false");
  $("bar").replaceChildren(log, button("Zoom in", "Or drag over a part", () => chart.zoom(0.7)), button("Zoom out", "", () => chart.zoom(1 / 0.7)), button("Show all", "Or double-click", () => chart.reset()), marks,
    button("Picture", "This figure as PNG", () => $("canvas").toBlob((/** @type {Blob} */ blob) => save("figure.png", blob, "image/png"))));
}

async function begin() {
  chart = new Chart($("canvas"));
  let timer = 0;
  chart.onrange = () => { clearTimeout(timer); timer = setTimeout(() => drawFits(state.turn), 60); };
  chart.onvalue = (text) => { $("under").textContent = text || "Values under the cursor stand here."; };
  chart.onmark = (places) => later(() => mark(places))();
  bar();
  chart.draw();
  // The module is in the page itself.
  const packed = Uint8Array.from(atob($("wasm").textContent), (letter) => letter.charCodeAt(0));
  bridge = new Bridge(packed, Number($("wasm").dataset.size), $("worker").textContent);
  about = await bridge.ask("about");
  $("version").textContent = about.version;
  READ = readSettings(about);
  SEARCH = searchSettings(about);
  fields(READ, $("read-fields"), later(readAll));
  fields(MASKS, $("mask-fields"), later(readAll));
  fields(SEARCH, $("search-fields"), later((() => {
    let model = "";
    return () => {
      if ($("option-model").value !== model) { model = $("option-model").value; boundFields(); }
      return changedFit();
    };
  })()));
  boundFields();
  $("choose").onclick = () => $("files").click();
  $("files").onchange = () => {
    const files = [...$("files").files];
    later(() => take(files))();
    $("files").value = "";
  };
  $("example").onclick = later(() => take([new File([$("example-data").textContent], "example.csv", { type: "text/csv" })]));
  $("scan").onchange = later(() => { state.current = Number($("scan").value); state.marked.clear(); showScan(); return changedFit(); });
  $("fit").onclick = later(fitNow);
  $("fit-all").onclick = later(fitAll);
  $("stop").onclick = () => { bridge.restart(); };
  for (const kind of ["dragenter", "dragover"]) document.addEventListener(kind, (event) => { event.preventDefault(); $("drop").classList.add("over"); });
  for (const kind of ["dragleave", "drop"]) document.addEventListener(kind, (event) => { event.preventDefault(); $("drop").classList.remove("over"); });
  document.addEventListener("drop", (event) => {
    const files = [...(event.dataTransfer?.files ?? [])];
    if (files.length) later(() => take(files))();
  });
  $("doing").textContent = "Ready";
  document.documentElement.dataset.ready = "yes";
}

// After the first paint, as unpacking the module takes longer than that.
requestAnimationFrame(() => setTimeout(() => begin().catch((error) => { $("doing").textContent = "Not started"; tell(new Told(`this browser cannot run the page: ${error.message ?? error}`)); }), 0));
