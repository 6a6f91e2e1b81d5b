//! Mitsuba 3: the exact model as a BSDF in Python, which evaluates, samples and gives densities.

use brdfit_core::brdf::NAMES;

use super::model::{Model, word};
use crate::error::Error;

/// The class; a lobe is sampled by its facets, and the lobes that are there equally often.
const CLASS: &str = r#"

class Brdfit(mi.BSDF):
    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        self.p = {name: float(props.get(name, value)) for name, value in PARAMETERS.items()}
        flags = mi.BSDFFlags.DiffuseReflection | mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide
        self.m_components = [flags]
        self.m_flags = flags
        self.lobes = [name for name in ("rho_d", "rho_s", "rho_v") if self.p[name] > 0] or ["rho_d"]

    def fresnel(self, c):
        n, kappa = self.p["n"], self.p["kappa"]
        c2 = dr.square(c)
        s2 = 1 - c2
        re, im = n * n - kappa * kappa - s2, 2 * n * kappa
        modulus = dr.sqrt(re * re + im * im)
        a = dr.sqrt(dr.maximum(0.5 * (modulus + re), 0))
        perpendicular = (modulus - 2 * a * c + c2) / (modulus + 2 * a * c + c2)
        parallel = (modulus * c2 - 2 * a * c * s2 + s2 * s2) / (modulus * c2 + 2 * a * c * s2 + s2 * s2)
        return 0.5 * perpendicular * (1 + parallel)

    def facets(self, wi, wo):
        """D_b, cos theta_h and cos theta_d of the facets that reflect wi to wo; tan theta_h without cancellation."""
        z2 = dr.square(wi.z + wo.z)
        t2 = dr.square(wi.x + wo.x) + dr.square(wi.y + wo.y)
        tan2, m2 = t2 / z2, self.p["m"] ** 2
        beckmann = dr.exp(-tan2 / m2) * dr.square(1 + tan2) / (dr.pi * m2)
        return beckmann, dr.rsqrt(1 + tan2), dr.minimum(0.5 * dr.sqrt(t2 + z2), 1)

    def brdf(self, wi, wo):
        """Eq. 14, sr^-1; both directions above the surface."""
        f = self.p["rho_d"] / dr.pi
        if self.p["rho_s"] > 0:
            d, cos_h, cos_d = self.facets(wi, wo)
            masking = dr.minimum(1, 2 * cos_h * dr.minimum(wi.z, wo.z) / cos_d)
            f += self.p["rho_s"] * d * self.fresnel(cos_d) * masking / (4 * wi.z * wo.z)
        if self.p["rho_v"] > 0:
            d, _, cos_d = self.facets(mirrored(wi), wo)
            f += self.p["rho_v"] * d * self.fresnel(cos_d)
        return f

    def density(self, wi, wo):
        total = mi.Float(0)
        for lobe in self.lobes:
            if lobe == "rho_d":
                total += wo.z / dr.pi
            else:
                d, cos_h, cos_d = self.facets(wi if lobe == "rho_s" else mirrored(wi), wo)
                total += d * cos_h / (4 * cos_d)
        return total / len(self.lobes)

    def above(self, wi, wo, active):
        return active & (wi.z > 0) & (wo.z > 0)

    def eval(self, ctx, si, wo, active=True):
        active = self.above(si.wi, wo, active)
        return dr.select(active, mi.Spectrum(self.brdf(si.wi, wo) * wo.z), 0)

    def pdf(self, ctx, si, wo, active=True):
        return dr.select(self.above(si.wi, wo, active), self.density(si.wi, wo), 0)

    def eval_pdf(self, ctx, si, wo, active=True):
        return self.eval(ctx, si, wo, active), self.pdf(ctx, si, wo, active)

    def sample(self, ctx, si, sample1, sample2, active=True):
        tan2 = -self.p["m"] ** 2 * dr.log(1 - sample2.x)
        cos_h = dr.rsqrt(1 + tan2)
        sin_phi, cos_phi = dr.sincos(2 * dr.pi * sample2.y)
        sin_h = cos_h * dr.sqrt(tan2)
        facet = mi.Vector3f(sin_h * cos_phi, sin_h * sin_phi, cos_h)
        wo = mi.warp.square_to_cosine_hemisphere(sample2)
        for place, lobe in enumerate(self.lobes):
            if lobe != "rho_d":
                wi = si.wi if lobe == "rho_s" else mirrored(si.wi)
                reflected = 2 * dr.dot(wi, facet) * facet - wi
                chosen = (sample1 * len(self.lobes) >= place) & (sample1 * len(self.lobes) < place + 1)
                wo = dr.select(chosen, reflected, wo)
        bs = mi.BSDFSample3f(wo)
        bs.pdf = self.pdf(ctx, si, wo, active)
        bs.eta = 1.0
        bs.sampled_type = mi.UInt32(+self.m_flags)
        bs.sampled_component = 0
        active = active & (bs.pdf > 0)
        return bs, dr.select(active, self.eval(ctx, si, wo, active) / dr.select(active, bs.pdf, 1), 0)

    def to_string(self):
        return f"Brdfit[{self.p}]"


def mirrored(w):
    return mi.Vector3f(-w.x, -w.y, w.z)


mi.register_bsdf(NAME, Brdfit)
"#;

/// The module.
pub fn write(model: &Model) -> Result<String, Error> {
    let params = model.eq_14("--to mitsuba")?;
    let name = word(&model.name);
    let mut text = format!(
        "# {}.\n# Modified Cook-Torrance model of Bishop, Butler and Marciniak (2021), Eq. 14, exact.\n",
        model.origin
    );
    text += &format!(
        "# Choose a variant, such as mi.set_variant(\"llvm_ad_rgb\"), import this, and use {{\"type\": \"{name}\"}}.\n"
    );
    text += &format!("import drjit as dr\nimport mitsuba as mi\n\nNAME = \"{name}\"\nPARAMETERS = {{\n");
    for (parameter, value) in NAMES.into_iter().zip(params.to_array()) {
        text += &format!("    \"{parameter}\": {value:?},\n");
    }
    Ok(text + "}\n" + CLASS)
}
