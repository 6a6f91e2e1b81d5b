// The figure: samples, curves and residuals over the scattering angle, one colour an angle of incidence.

/**
 * @typedef {{theta_i: number[], x: number[], out_of_plane: boolean[], f: number[], weight: number[], line: number[], reason: string[]}} Points
 * @typedef {{curves: {theta_i: number, x: number[], f: number[]}[], residuals: (number | null)[]}} Drawn
 * @typedef {[number, number]} Span
 */

const INK = "#1c2330", SOFT = "#56606f", GRID = "#e3e8ee";

/**
 * Colours from blue to red by way of green, dark enough on white.
 * @param {number} k
 * @param {number} count
 */
function colour(k, count) {
  const stops = [[43, 79, 163], [14, 122, 140], [46, 125, 50], [168, 110, 0], [176, 42, 32]];
  const at = count < 2 ? 0 : (k / (count - 1)) * (stops.length - 1);
  const [low, part] = [Math.min(Math.floor(at), stops.length - 2), at - Math.min(Math.floor(at), stops.length - 2)];
  const mix = stops[low].map((value, j) => Math.round(value + part * (stops[low + 1][j] - value)));
  return `rgb(${mix.join(",")})`;
}

/**
 * Round values between two.
 * @param {Span} range
 * @param {number} count
 */
function ticks([low, high], count) {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((k) => k >= rough) ?? rough;
  const list = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) list.push(k * step);
  return list;
}

class Chart {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    /** @type {Points | null} */
    this.points = null;
    /** @type {Points | null} */
    this.leftOut = null;
    /** @type {{drawn: Drawn, best: boolean}[]} */
    this.fits = [];
    /** @type {number[]} */
    this.angles = [];
    /**
     * Angles of incidence that are not shown.
     * @type {Set<number>}
     */
    this.hidden = new Set();
    this.log = true;
    /**
     * What dragging does.
     * @type {"zoom" | "mark"}
     */
    this.mode = "zoom";
    /** @type {Span} */ this.x = [-90, 90];
    /** @type {Span} in the axis' own scale */ this.y = [0, 1];
    this.zoomed = false;
    /** @type {number | null} place of the sample under the cursor */ this.at = null;
    /** @type {{from: [number, number], to: [number, number]} | null} */ this.drag = null;
    this.onrange = () => {};
    /** @type {(places: number[]) => void} */ this.onmark = () => {};
    /** @type {(text: string) => void} */ this.onvalue = () => {};
    new ResizeObserver(() => this.draw()).observe(canvas);
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.release(event));
    canvas.addEventListener("pointercancel", () => { this.drag = null; this.draw(); });
    canvas.addEventListener("dblclick", () => this.reset());
    canvas.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && !event.shiftKey) return;
      event.preventDefault();
      this.zoom(event.deltaY < 0 ? 0.8 : 1.25, this.place(event));
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  /** @param {Points | null} points @param {Points | null} leftOut */
  show(points, leftOut) {
    this.points = points;
    this.leftOut = leftOut;
    this.fits = [];
    this.at = null;
    this.angles = [...new Set(points?.theta_i ?? [])].sort((a, b) => a - b);
    this.hidden = new Set([...this.hidden].filter((angle) => this.angles.includes(angle)));
    this.reset();
  }

  /**
   * Linear or logarithmic.
   * @param {number} f
   */
  scale(f) { return this.log ? Math.log10(f) : f; }

  reset() {
    this.zoomed = false;
    this.fitRange();
    this.draw();
    this.onrange();
  }

  fitRange() {
    const points = this.points;
    if (!points || points.x.length === 0) { this.x = [-90, 90]; this.y = [0, 1]; return; }
    let [x0, x1, y0, y1] = [Infinity, -Infinity, Infinity, -Infinity];
    for (let k = 0; k < points.x.length; k++) {
      if (this.hidden.has(points.theta_i[k])) continue;
      const [x, y] = [points.x[k], this.scale(points.f[k])];
      if (x < x0) x0 = x;
      if (x > x1) x1 = x;
      if (Number.isFinite(y) && y < y0) y0 = y;
      if (y > y1) y1 = y;
    }
    if (!(x0 < Infinity)) [x0, x1, y0, y1] = [-90, 90, 0, 1];
    const [dx, dy] = [0.03 * (x1 - x0) || 1, 0.06 * (y1 - y0) || 0.5];
    this.x = [Math.max(x0 - dx, -90), Math.min(x1 + dx, 90)];
    this.y = this.log ? [y0 - dy, y1 + dy] : [Math.min(0, y0), y1 + dy];
    if (!(this.x[0] < this.x[1])) this.x = [x0 - 1, x1 + 1];
  }

  /** Boxes of both parts, in pixels of the page. */
  boxes() {
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    const left = 62, right = width - 10, top = 8, bottom = height - 38;
    const split = top + Math.round((bottom - top) * 0.72);
    return { width, height, main: { left, right, top, bottom: split }, rest: { left, right, top: split + 16, bottom } };
  }

  /** @param {{clientX: number, clientY: number}} event @returns {[number, number]} */
  place(event) {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  /** @param {[number, number]} pixel @returns {[number, number]} */
  value([px, py]) {
    const { main } = this.boxes();
    const part = (py - main.bottom) / (main.top - main.bottom);
    return [this.x[0] + ((px - main.left) / (main.right - main.left)) * (this.x[1] - this.x[0]), this.y[0] + part * (this.y[1] - this.y[0])];
  }

  /** @param {number} factor @param {[number, number]} [pixel] */
  zoom(factor, pixel) {
    const { main } = this.boxes();
    const [cx, cy] = this.value(pixel ?? [(main.left + main.right) / 2, (main.top + main.bottom) / 2]);
    this.x = [Math.max(cx + factor * (this.x[0] - cx), -90), Math.min(cx + factor * (this.x[1] - cx), 90)];
    this.y = [cy + factor * (this.y[0] - cy), cy + factor * (this.y[1] - cy)];
    this.zoomed = true;
    this.draw();
    this.onrange();
  }

  /** @param {PointerEvent} event */
  press(event) {
    if (!this.points || event.button !== 0) return;
    const at = this.place(event);
    this.drag = { from: at, to: at };
    try { this.canvas.setPointerCapture(event.pointerId); } catch { /* the pointer is gone already */ }
  }

  /** @param {PointerEvent} event */
  move(event) {
    const at = this.place(event);
    if (this.drag) { this.drag.to = at; this.draw(); return; }
    this.point(this.nearest(at));
  }

  /** @param {PointerEvent} event */
  release(event) {
    const drag = this.drag;
    this.drag = null;
    if (!drag) return;
    const [[x0, y0], [x1, y1]] = [drag.from, drag.to];
    if (Math.abs(x1 - x0) < 5 && Math.abs(y1 - y0) < 5) { this.point(this.nearest(drag.to)); this.draw(); return; }
    const [a, b] = [this.value(drag.from), this.value(drag.to)];
    const x = /** @type {Span} */ ([Math.min(a[0], b[0]), Math.max(a[0], b[0])]);
    const y = /** @type {Span} */ ([Math.min(a[1], b[1]), Math.max(a[1], b[1])]);
    if (this.mode === "mark") {
      const points = /** @type {Points} */ (this.points);
      const inside = points.x.map((_, k) => k).filter((k) => {
        const value = this.scale(points.f[k]);
        return !this.hidden.has(points.theta_i[k]) && points.x[k] >= x[0] && points.x[k] <= x[1] && value >= y[0] && value <= y[1];
      });
      this.draw();
      this.onmark(inside);
      return;
    }
    this.x = [Math.max(x[0], -90), Math.min(x[1], 90)];
    this.y = y;
    this.zoomed = true;
    this.draw();
    this.onrange();
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const points = this.points;
    if (!points) return;
    if (event.key === "ArrowRight" || event.key === "ArrowLeft") {
      const step = event.key === "ArrowRight" ? 1 : -1;
      const next = Math.min(Math.max((this.at ?? (step > 0 ? -1 : points.x.length)) + step, 0), points.x.length - 1);
      this.point(next);
    } else if (event.key === "+" || event.key === "=") this.zoom(0.8);
    else if (event.key === "-") this.zoom(1.25);
    else if (event.key === "Home" || event.key === "0") this.reset();
    else return;
    event.preventDefault();
  }

  /** @param {[number, number]} pixel @returns {number | null} */
  nearest([px, py]) {
    const points = this.points;
    if (!points) return null;
    const { main } = this.boxes();
    const [kx, ky] = [(main.right - main.left) / (this.x[1] - this.x[0]), (main.top - main.bottom) / (this.y[1] - this.y[0])];
    let [best, least] = [/** @type {number | null} */ (null), 40 ** 2];
    for (let k = 0; k < points.x.length; k++) {
      if (this.hidden.has(points.theta_i[k])) continue;
      const dx = main.left + (points.x[k] - this.x[0]) * kx - px;
      const dy = main.bottom + (this.scale(points.f[k]) - this.y[0]) * ky - py;
      const distance = dx * dx + (py > main.bottom ? 0 : dy * dy);
      if (distance < least) [best, least] = [k, distance];
    }
    return best;
  }

  /**
   * Tells a sample's values.
   * @param {number | null} place
   */
  point(place) {
    if (place === this.at) return;
    this.at = place;
    this.draw();
    const points = this.points;
    if (place === null || !points) { this.onvalue(""); return; }
    const residual = this.fits.find((fit) => fit.best)?.drawn.residuals[place];
    const parts = [
      `sample ${place + 1}`, `incidence ${digits(points.theta_i[place], 5)}°`,
      `${points.out_of_plane[place] ? "out of plane, from specular" : "scattering"} ${digits(points.x[place], 5)}°`,
      `BRDF ${digits(points.f[place], 5)} /sr`,
    ];
    if (residual !== undefined && residual !== null) {
      const plain = residual / (points.weight[place] || 1);
      parts.push(`fit ${digits(points.f[place] * Math.exp(plain), 5)} /sr`, `residual ${digits(100 * plain, 3)} %`);
    }
    if (points.line[place]) parts.push(`line ${points.line[place]}`);
    this.onvalue(parts.join(", "));
  }

  draw() {
    const canvas = this.canvas, ratio = window.devicePixelRatio || 1;
    const { width, height, main, rest } = this.boxes();
    if (width === 0) return;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    pen.scale(ratio, ratio);
    pen.font = "12px system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif";
    const px = (/** @type {number} */ x) => main.left + ((x - this.x[0]) / (this.x[1] - this.x[0])) * (main.right - main.left);
    const py = (/** @type {number} */ y) => main.bottom + ((y - this.y[0]) / (this.y[1] - this.y[0])) * (main.top - main.bottom);
    this.axes(pen, main, rest, px, py);
    const points = this.points;
    if (!points) {
      pen.fillStyle = SOFT;
      pen.textAlign = "center";
      pen.fillText("Drop a scan, or load the example.", (main.left + main.right) / 2, (main.top + main.bottom) / 2);
      return;
    }
    const shade = new Map(this.angles.map((angle, k) => [angle, colour(k, this.angles.length)]));
    const inside = (/** @type {{left: number, right: number, top: number, bottom: number}} */ box, /** @type {() => void} */ act) => {
      pen.save();
      pen.beginPath();
      pen.rect(box.left, box.top, box.right - box.left, box.bottom - box.top);
      pen.clip();
      act();
      pen.restore();
    };
    inside(main, () => {
      pen.strokeStyle = "#9aa3b0";
      pen.lineWidth = 1;
      for (let k = 0; k < (this.leftOut?.x.length ?? 0); k++) {
        const out = /** @type {Points} */ (this.leftOut);
        const [x, y] = [px(out.x[k]), py(this.scale(out.f[k]))];
        pen.beginPath();
        pen.moveTo(x - 3, y - 3); pen.lineTo(x + 3, y + 3); pen.moveTo(x + 3, y - 3); pen.lineTo(x - 3, y + 3);
        pen.stroke();
      }
      this.dots(pen, points, shade, px, (k) => py(this.scale(points.f[k])));
      for (const { drawn, best } of this.fits) {
        for (const { theta_i, x, f } of drawn.curves) {
          if (this.hidden.has(theta_i)) continue;
          pen.beginPath();
          pen.strokeStyle = best ? INK : (shade.get(theta_i) ?? SOFT);
          pen.lineWidth = best ? 1.6 : 1;
          pen.setLineDash(best ? [] : [5, 4]);
          x.forEach((at, k) => pen.lineTo(px(at), Math.max(Math.min(py(this.scale(f[k])), 1e5), -1e5)));
          pen.stroke();
          pen.setLineDash([]);
        }
      }
    });
    const residuals = this.fits.find((fit) => fit.best)?.drawn.residuals;
    if (residuals) this.rest(pen, rest, points, residuals, shade, px, inside);
    if (this.at !== null) {
      pen.strokeStyle = INK;
      pen.lineWidth = 2;
      pen.beginPath();
      pen.arc(px(points.x[this.at]), py(this.scale(points.f[this.at])), 6, 0, 7);
      pen.stroke();
    }
    if (this.drag) {
      const [[x0, y0], [x1, y1]] = [this.drag.from, this.drag.to];
      pen.fillStyle = this.mode === "mark" ? "rgba(161,22,10,.15)" : "rgba(11,92,173,.15)";
      pen.strokeStyle = this.mode === "mark" ? "#a1160a" : "#0b5cad";
      pen.lineWidth = 1;
      pen.fillRect(x0, y0, x1 - x0, y1 - y0);
      pen.strokeRect(x0, y0, x1 - x0, y1 - y0);
    }
  }

  /**
   * @param {CanvasRenderingContext2D} pen @param {Points} points @param {Map<number, string>} shade
   * @param {(x: number) => number} px @param {(k: number) => number} y
   */
  dots(pen, points, shade, px, y) {
    const size = points.x.length > 3000 ? 1.2 : points.x.length > 600 ? 1.8 : 2.6;
    for (let k = 0; k < points.x.length; k++) {
      if (this.hidden.has(points.theta_i[k])) continue;
      const [at, height] = [px(points.x[k]), y(k)];
      pen.fillStyle = pen.strokeStyle = shade.get(points.theta_i[k]) ?? INK;
      if (points.out_of_plane[k]) pen.strokeRect(at - size, height - size, 2 * size, 2 * size);
      else if (size < 2) pen.fillRect(at - size, height - size, 2 * size, 2 * size);
      else { pen.beginPath(); pen.arc(at, height, size, 0, 7); pen.fill(); }
    }
  }

  /** @param {CanvasRenderingContext2D} pen @param {any} main @param {any} rest @param {(x: number) => number} px @param {(y: number) => number} py */
  axes(pen, main, rest, px, py) {
    pen.lineWidth = 1;
    pen.textBaseline = "middle";
    pen.textAlign = "right";
    const marks = this.log
      ? ticks(this.y, 5).filter((y) => this.y[1] - this.y[0] < 2 || Math.abs(y - Math.round(y)) < 1e-9).map((y) => /** @type {[number, string]} */ ([y, Math.abs(y - Math.round(y)) < 1e-9 ? power(Math.round(y)) : digits(10 ** y, 3)]))
      : ticks(this.y, 5).map((y) => /** @type {[number, string]} */ ([y, digits(y, 4)]));
    for (const [y, text] of marks) {
      pen.strokeStyle = GRID;
      pen.beginPath(); pen.moveTo(main.left, py(y)); pen.lineTo(main.right, py(y)); pen.stroke();
      pen.fillStyle = SOFT;
      pen.fillText(text, main.left - 6, py(y));
    }
    pen.textAlign = "center";
    pen.textBaseline = "top";
    for (const x of ticks(this.x, Math.max(3, Math.round((main.right - main.left) / 90)))) {
      for (const box of [main, rest]) {
        pen.strokeStyle = GRID;
        pen.beginPath(); pen.moveTo(px(x), box.top); pen.lineTo(px(x), box.bottom); pen.stroke();
      }
      pen.fillStyle = SOFT;
      pen.fillText(digits(x, 4), px(x), rest.bottom + 4);
    }
    pen.strokeStyle = "#8a94a3";
    for (const box of [main, rest]) pen.strokeRect(box.left + 0.5, box.top + 0.5, box.right - box.left - 1, box.bottom - box.top - 1);
    pen.fillStyle = INK;
    pen.fillText("scattering angle, degrees (positive: forward)", (main.left + main.right) / 2, rest.bottom + 20);
    const upright = (/** @type {string} */ text, /** @type {any} */ box) => {
      pen.save();
      pen.translate(11, (box.top + box.bottom) / 2);
      pen.rotate(-Math.PI / 2);
      pen.textBaseline = "middle";
      pen.fillText(text, 0, 0);
      pen.restore();
    };
    upright("BRDF, 1/sr", main);
    upright("residual, %", rest);
  }

  /**
   * @param {CanvasRenderingContext2D} pen @param {any} box @param {Points} points @param {(number | null)[]} residuals
   * @param {Map<number, string>} shade @param {(x: number) => number} px @param {(box: any, act: () => void) => void} inside
   */
  rest(pen, box, points, residuals, shade, px, inside) {
    const sizes = residuals.filter((r, k) => r !== null && !this.hidden.has(points.theta_i[k])).map((r) => Math.abs(/** @type {number} */ (r))).sort((a, b) => a - b);
    // A few outliers do not press all others onto the line.
    const most = 1.15 * (Math.max(sizes[Math.floor(0.98 * (sizes.length - 1))] ?? 0, 1e-9));
    const py = (/** @type {number} */ r) => (box.top + box.bottom) / 2 - (r / most) * (box.bottom - box.top) / 2;
    pen.fillStyle = SOFT;
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    for (const r of ticks([-most, most], 3)) pen.fillText(digits(100 * r, 3), box.left - 6, py(r));
    inside(box, () => {
      pen.strokeStyle = "#8a94a3";
      pen.beginPath(); pen.moveTo(box.left, py(0)); pen.lineTo(box.right, py(0)); pen.stroke();
      this.dots(pen, points, shade, px, (k) => {
        const r = residuals[k];
        return r === null ? -99 : Math.min(Math.max(py(r), box.top + 2), box.bottom - 2);
      });
    });
  }
}

/** @param {number} exponent */
function power(exponent) {
  if (exponent >= -3 && exponent <= 4) return digits(10 ** exponent, 4);
  return "10" + String(exponent).replace(/[-\d]/g, (c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(c)] ?? "⁻");
}
