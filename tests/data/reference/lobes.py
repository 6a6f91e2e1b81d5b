"""Writes lobes.csv: ln f of models put together from other lobes, and its derivatives, in 60-digit arithmetic.

    pip install mpmath && python lobes.py > lobes.csv

The formulas are as printed in their sources: Eq. 5 to 14 of the paper; Trowbridge and Reitz 1975 (GGX); Walter, Marschner, Li and Torrance 2007, Eq. 33 and 34 and section 5.2 (GGX, and Smith's masking for both distributions).
All inputs are numbers of type f64, taken exactly; angles in radians.
"""

import random
from mpmath import mp, mpf, cos, sin, tan, acos, sqrt, exp, log, pi, diff

mp.dps = 60
NAMES = ["rho_d", "rho_s", "rho_v", "m", "n", "kappa", "m_v", "rho_2", "m_2"]


def beckmann(theta_h, m):
    return exp(-((tan(theta_h) / m) ** 2)) / (pi * m**2 * cos(theta_h) ** 4)


def ggx(theta_h, m):
    return m**2 / (pi * cos(theta_h) ** 4 * (m**2 + tan(theta_h) ** 2) ** 2)


def g1_beckmann(theta, m):
    if theta == 0:
        return mpf(1)
    a = 1 / (m * abs(tan(theta)))
    if a >= mpf("1.6"):
        return mpf(1)
    return (mpf("3.535") * a + mpf("2.181") * a**2) / (1 + mpf("2.276") * a + mpf("2.577") * a**2)


def g1_ggx(theta, m):
    return 2 / (1 + sqrt(1 + (m * tan(theta)) ** 2))


DISTRIBUTION = {"beckmann": beckmann, "ggx": ggx}
G1 = {"beckmann": g1_beckmann, "ggx": g1_ggx}


def half_angles(ti, ts, azimuth):
    td = acos(cos(ti) * cos(ts) + sin(ti) * sin(ts) * cos(azimuth)) / 2
    return td, acos((cos(ti) + cos(ts)) / (2 * cos(td)))


def fresnel(theta, n, kappa):
    p = sqrt((n - 1j * kappa) ** 2 - sin(theta) ** 2)
    rs = (cos(theta) - p) / (cos(theta) + p)
    rp = ((n - 1j * kappa) ** 2 * cos(theta) - p) / ((n - 1j * kappa) ** 2 * cos(theta) + p)
    return (abs(rs) ** 2 + abs(rp) ** 2) / 2


def ln_f(distribution, masking, angles, x):
    rho_d, rho_s, rho_v, m, n, kappa, m_v, rho_2, m_2 = x
    ti, ts, phi = angles
    D = DISTRIBUTION[distribution]
    td, th = half_angles(ti, ts, phi)
    tde, the = half_angles(ti, ts, phi - pi)

    def g(m):
        if masking == "smith":
            return G1[distribution](ti, m) * G1[distribution](ts, m)
        if masking == "none":
            return 1
        return min(mpf(1), 2 * cos(th) * cos(ts) / cos(td), 2 * cos(th) * cos(ti) / cos(td))

    sigma = 1 / (4 * cos(ti) * cos(ts))
    surface = sigma * fresnel(td, n, kappa) * (rho_s * D(th, m) * g(m) + rho_2 * D(th, m_2) * g(m_2))
    return log(rho_d / pi + surface + rho_v * D(the, m_v) * fresnel(tde, n, kappa))


random.seed(1)
print("distribution,masking,theta_i,theta_s,delta_phi," + ",".join(NAMES) + ",ln_f," + ",".join("d_" + name for name in NAMES))
for distribution in DISTRIBUTION:
    for masking in ["v-groove", "smith", "none"]:
        for case in range(12):
            ti = random.uniform(0, 1.5)
            ts = random.uniform(-1.5, 1.5)
            if case % 3 == 0:
                ts = ti + random.uniform(-0.05, 0.05) if ti < 1.4 else -ti / 2
            phi = random.uniform(0.3, 2.9) if case % 4 == 3 else 3.141592653589793
            m, m_v, m_2 = (10 ** random.uniform(-1, 0.5) for _ in range(3))
            x = [random.uniform(0.01, 0.5), 10 ** random.uniform(-2, 2), 10 ** random.uniform(-2, 1), m]
            x += [random.uniform(1.1, 5), random.uniform(0.1, 5), m_v, 10 ** random.uniform(-2, 2), m_2]
            # In the plane, exactly.
            angles = [mpf(ti), mpf(ts), pi if phi == 3.141592653589793 else mpf(phi)]
            point = [mpf(value) for value in x]
            values = [ln_f(distribution, masking, angles, point)]
            for k in range(9):
                values.append(diff(lambda y: ln_f(distribution, masking, angles, point[:k] + [y] + point[k + 1 :]), point[k]))
            cells = [distribution, masking] + [repr(v) for v in [ti, ts, phi] + x] + [mp.nstr(mp.re(v), 20) for v in values]
            print(",".join(cells))
