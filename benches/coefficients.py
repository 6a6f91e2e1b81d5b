"""Where the coefficients of core/src/real.rs are from: each polynomial against the function that it stands for, in 40 digits.

    python3 benches/coefficients.py

For each it prints the largest error of the coefficients that the core has, and that of the best polynomial of the same form, with its coefficients, by Remez's exchange: their ratio is near 1 where they are the rounded best.
It is 2 for rsqrt, whose polynomial is the best times one less its error, so that x y^2 stays below 1; and more where the coefficients are those of FreeBSD's msun (ln in f32, cos in f64), or rounded to what the type holds (exp in f32), all far below the type's epsilon.
It needs mpmath. Rounding of the result is not looked at here: tests/elementary.rs finds at most 1 ulp over a million points each.
"""

from mpmath import cos, exp, log, lu_solve, matrix, mp, mpf, pi, sin, sqrt

mp.dps = 40


def poly(c, x):
    total = mpf(0)
    for a in reversed(c):
        total = total * x + a
    return total


def grid(a, b, count=4000):
    """Points that are dense at the ends, where errors of polynomials are largest."""
    return [(a + b) / 2 - (b - a) / 2 * cos(pi * k / count) for k in range(count + 1)]


def largest(error, a, b):
    return max(abs(error(x)) for x in grid(a, b))


def remez(f, weight, degree, a, b):
    """The polynomial p of least largest weight (p - f), and that."""
    points = [(a + b) / 2 - (b - a) / 2 * cos(pi * k / (degree + 1)) for k in range(degree + 2)]
    for _ in range(12):
        rows = matrix(degree + 2, degree + 2)
        right = matrix(degree + 2, 1)
        for i, x in enumerate(points):
            for j in range(degree + 1):
                rows[i, j] = x**j
            rows[i, degree + 1] = (-1) ** i / weight(x)
            right[i] = f(x)
        found = list(lu_solve(rows, right))
        c, level = found[:-1], abs(found[-1])
        error = lambda x: weight(x) * (poly(c, x) - f(x))
        # The largest of each run of one sign is the next point.
        runs = []
        for x in grid(a, b):
            e = error(x)
            if runs and (runs[-1][1] > 0) == (e > 0):
                if abs(e) > abs(runs[-1][1]):
                    runs[-1] = (x, e)
            else:
                runs.append((x, e))
        while len(runs) > degree + 2:
            runs.pop(0 if abs(runs[0][1]) < abs(runs[-1][1]) else -1)
        if len(runs) < degree + 2:
            break
        points = [x for x, _ in runs]
        most = max(abs(e) for _, e in runs)
        if most < level * (1 + mpf(10) ** -6):
            break
    return c, most


def show(name, f, weight, committed, a, b):
    committed = [mpf(c) for c in committed]
    a, b = mpf(a), mpf(b)
    has = largest(lambda x: weight(x) * (poly(committed, x) - f(x)), a, b)
    best, least = remez(f, weight, len(committed) - 1, a, b)
    print(f"{name}: error {mp.nstr(has, 3)}, at best {mp.nstr(least, 3)}, ratio {mp.nstr(has / least, 3)}")
    print("    by Remez: " + ", ".join(mp.nstr(c, 12) for c in best))


def series(f, x, first, ratio):
    """f away from 0, and near it, where f cancels, the sum of first and what ratio makes of each term."""
    if abs(x) > mpf(10) ** -4:
        return f(x)
    total = term = mpf(first)
    for k in range(1, 8):
        term *= ratio(k, x)
        total += term
    return total


def main():
    half_ln2 = log(2) / 2
    near = mpf(10) ** -9

    # e^r = 1 + r + r^2 q(r), relative to e^r.
    q = lambda r: series(lambda r: (exp(r) - 1 - r) / r**2, r, "0.5", lambda k, r: r / (k + 2))
    weight = lambda r: max(r * r, near) / exp(r)
    show("f64 exp, q(r)", q, weight,
         ["0.50000000000000106193", "0.16666666666666412565", "0.04166666666653021307", "0.0083333333334944540293",
          "0.0013888888943617655163", "0.00019841269506566275695", "0.000024801493110457706946",
          "2.7557586403722180258e-6", "2.7630244623105247585e-7", "2.5000047638844076848e-8"], -half_ln2, half_ln2)
    # In single precision the first coefficient is 1/2, which every number has exactly.
    q1 = lambda r: series(lambda r: ((exp(r) - 1 - r) / r**2 - mpf(1) / 2) / r, r, mpf(1) / 6, lambda k, r: r / (k + 3))
    weight = lambda r: max(abs(r) ** 3, near) / exp(r)
    show("f32 exp, (q(r) - 1/2) / r", q1, weight,
         ["0.16666576989", "0.04166655462", "0.00836317905", "0.00139261836"], -half_ln2, half_ln2)

    # ln(1 + f) = 2 atanh(s) with s = f / (2 + f): 2 atanh(s) = 2 s + s R(z), z = s^2; relative to 2 s.
    def rest(z):
        atanh = lambda s: log((1 + s) / (1 - s)) / 2
        return series(lambda z: 2 * atanh(sqrt(z)) / sqrt(z) - 2, z, 2 * z / 3, lambda k, z: z * (2 * k + 1) / (2 * k + 3))

    top = ((sqrt(2) - 1) / (sqrt(2) + 1)) ** 2
    without = lambda z: rest(z) / z if z > near else mpf(2) / 3
    weight = lambda z: max(z, near) / 2
    show("f64 ln, R(z) / z", without, weight,
         ["6.666666666666735130e-01", "3.999999999940941908e-01", "2.857142874366239149e-01",
          "2.222219843214978396e-01", "1.818357216161805012e-01", "1.531383769920937332e-01",
          "1.479819860510658591e-01"], 0, top)
    show("f32 ln, R(z) / z", without, weight,
         ["0.66666662693", "0.40000972152", "0.28498786688", "0.24279078841"], 0, top)

    # 1/sqrt(x) = y p(x y^2), where y is an estimate from the exponent; relative. The interval is what the estimate leaves of x y^2.
    root = lambda z: 1 / sqrt(z)
    relative = lambda z: sqrt(z)
    show("f64 rsqrt, p(z)", root, relative,
         ["2.189331153343104", "-2.1917187332715744", "1.3154395307923215", "-0.31305345781413524"],
         *estimates(0x5FE6EB50C7B537A9, 52, 1023))
    show("f32 rsqrt, p(z)", root, relative, ["1.8765496290", "-1.2520675584", "0.3754921437"],
         *estimates(0x5F3759DF, 23, 127))

    # sin r = r + r^3 S(z), cos r = 1 - z/2 + z^2 C(z), z = r^2 up to (pi/4)^2; relative to the result.
    end = (pi / 4) ** 2
    sine = lambda z: series(lambda z: (sin(sqrt(z)) / sqrt(z) - 1) / z, z, mpf(-1) / 6,
                            lambda k, z: -z / ((2 * k + 2) * (2 * k + 3)))
    cosine = lambda z: series(lambda z: (cos(sqrt(z)) - 1 + z / 2) / z**2, z, mpf(1) / 24,
                              lambda k, z: -z / ((2 * k + 3) * (2 * k + 4)))
    of_sine = lambda z: max(z, near) * (sqrt(z) / sin(sqrt(z)) if z > 0 else 1)
    of_cosine = lambda z: max(z, near) ** 2 / cos(sqrt(z))
    show("f64 sin, S(z)", sine, of_sine,
         ["-1.66666666666666324348e-01", "8.33333333332248946124e-03", "-1.98412698298579493134e-04",
          "2.75573137070700676789e-06", "-2.50507602534068634195e-08", "1.58969099521155010221e-10"], 0, end)
    show("f64 cos, C(z)", cosine, of_cosine,
         ["4.16666666666666019037e-02", "-1.38888888888741095749e-03", "2.48015872894767294178e-05",
          "-2.75573143513906633035e-07", "2.08757232129817482790e-09", "-1.13596475577881948265e-11"], 0, end)
    show("f32 sin, S(z)", sine, of_sine, ["-0.166666545731", "0.00833215840813", "-0.000195149574311"], 0, end)
    show("f32 cos, C(z)", cosine, of_cosine, ["0.0416666456188", "-0.00138873130615", "2.44327849494e-5"], 0, end)


def estimates(magic, digits, bias):
    """The least and the largest x y^2 of y, the number of the bits magic - bits(x) / 2, over two binades of x."""

    def number(bits):
        return (1 + mpf(bits & ((1 << digits) - 1)) / (1 << digits)) * mpf(2) ** ((bits >> digits) - bias)

    # y is a straight line between powers of 2, so the extremes are at ends and in the middle: a fine grid has them.
    found = []
    for exponent in (bias, bias + 1):
        for k in range(4096):
            bits = (exponent << digits) + (k << (digits - 12))
            found.append(number(bits) * number(magic - (bits >> 1)) ** 2)
    return min(found), max(found)


main()
