// LZMA, a third smaller than what browsers unpack by themselves: the decoder of Pavlov's LZMA specification (public domain).

/**
 * @param {Uint8Array} from a file of `xz --format=lzma`
 * @param {number} size of what is in it
 */
function unpack(from, size) {
  const [lc, lp, pb] = [from[0] % 9, Math.floor(from[0] / 9) % 5, Math.floor(from[0] / 45)];
  const out = new Uint8Array(size);
  // Models of all bits, one after the other.
  let models = 0;
  const some = (/** @type {number} */ count) => (models += count) - count;
  const [isMatch, isRep, isRep0, isRep1, isRep2, isLong] = [some(12 << 4), some(12), some(12), some(12), some(12), some(12 << 4)];
  const [slots, special, align, literals] = [some(4 << 6), some(128), some(16), some(0x300 << (lc + lp))];
  const length = () => ({ choice: some(2), low: some(16 << 3), mid: some(16 << 3), high: some(256) });
  const [matchLength, repLength] = [length(), length()];
  const p = new Uint16Array(models).fill(1024);

  let [next, range, code] = [14, 0xffffffff, 0];
  for (let k = 0; k < 4; k++) code = ((code << 8) | from[next++]) >>> 0;

  const normalize = () => {
    if (range >= 0x1000000) return;
    range = (range << 8) >>> 0;
    code = ((code << 8) | from[next++]) >>> 0;
  };
  const bit = (/** @type {number} */ at) => {
    const bound = (range >>> 11) * p[at];
    let found = 0;
    if (code < bound) {
      range = bound;
      p[at] += (2048 - p[at]) >> 5;
    } else {
      range = (range - bound) >>> 0;
      code = (code - bound) >>> 0;
      p[at] -= p[at] >> 5;
      found = 1;
    }
    normalize();
    return found;
  };
  const tree = (/** @type {number} */ at, /** @type {number} */ bits) => {
    let node = 1;
    for (let k = 0; k < bits; k++) node = (node << 1) | bit(at + node);
    return node - (1 << bits);
  };
  const reverse = (/** @type {number} */ at, /** @type {number} */ bits) => {
    let [node, found] = [1, 0];
    for (let k = 0; k < bits; k++) {
      const one = bit(at + node);
      node = (node << 1) | one;
      found |= one << k;
    }
    return found;
  };
  const direct = (/** @type {number} */ bits) => {
    let found = 0;
    for (let k = 0; k < bits; k++) {
      range >>>= 1;
      const one = code >= range ? 1 : 0;
      if (one) code = (code - range) >>> 0;
      normalize();
      found = found * 2 + one;
    }
    return found;
  };
  const lengthOf = (/** @type {{choice: number, low: number, mid: number, high: number}} */ of, /** @type {number} */ place) => {
    if (!bit(of.choice)) return 2 + tree(of.low + (place << 3), 3);
    if (!bit(of.choice + 1)) return 10 + tree(of.mid + (place << 3), 3);
    return 18 + tree(of.high, 8);
  };

  let [at, state, rep0, rep1, rep2, rep3] = [0, 0, 0, 0, 0, 0];
  while (at < size) {
    const place = at & ((1 << pb) - 1);
    if (!bit(isMatch + (state << 4) + place)) {
      const before = at > 0 ? out[at - 1] : 0;
      const base = literals + 0x300 * (((at & ((1 << lp) - 1)) << lc) + (before >> (8 - lc)));
      let symbol = 1;
      if (state >= 7) {
        let match = out[at - rep0 - 1];
        do {
          const hint = (match >> 7) & 1;
          match <<= 1;
          const one = bit(base + ((1 + hint) << 8) + symbol);
          symbol = (symbol << 1) | one;
          if (hint !== one) break;
        } while (symbol < 0x100);
      }
      while (symbol < 0x100) symbol = (symbol << 1) | bit(base + symbol);
      out[at++] = symbol;
      state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
      continue;
    }
    let count;
    if (bit(isRep + state)) {
      if (!bit(isRep0 + state)) {
        if (!bit(isLong + (state << 4) + place)) {
          state = state < 7 ? 9 : 11;
          out[at] = out[at - rep0 - 1];
          at++;
          continue;
        }
      } else {
        let distance = rep1;
        if (bit(isRep1 + state)) {
          if (bit(isRep2 + state)) [distance, rep3] = [rep3, rep2];
          else distance = rep2;
          rep2 = rep1;
        }
        rep1 = rep0;
        rep0 = distance;
      }
      count = lengthOf(repLength, place);
      state = state < 7 ? 8 : 11;
    } else {
      [rep3, rep2, rep1] = [rep2, rep1, rep0];
      count = lengthOf(matchLength, place);
      state = state < 7 ? 7 : 10;
      const slot = tree(slots + (Math.min(count - 2, 3) << 6), 6);
      rep0 = slot;
      if (slot >= 4) {
        const bits = (slot >> 1) - 1;
        rep0 = (2 | (slot & 1)) * 2 ** bits;
        if (slot < 14) rep0 += reverse(special + rep0 - slot, bits);
        else rep0 += direct(bits - 4) * 16 + reverse(align, 4);
      }
    }
    if (rep0 >= at || at + count > size) throw new Error("the module in this page is damaged");
    for (let k = 0; k < count; k++, at++) out[at] = out[at - rep0 - 1];
  }
  return out;
}
