//! Every model that is compiled in, that of the paper first.

use brdfit_core::brdf::{ABSORBING, ALL, DIFFUSE, MIRRORS, OWN_SLOPE, SECOND, SURFACE, TAIL, VOLUME};
use brdfit_core::formula::Own;
use brdfit_core::lobes::{
    Beckmann, Distribution, Exponential, Ggx, HyperCauchy, InAngle, Masking, NoMasking, Smith, VGroove,
};
use brdfit_core::microfacet::Microfacet;
use brdfit_core::models::{Abg, BeardMaxwell, HarveyShack, KCorrelation, KCorrelation2};

use crate::bind::{searches, set};
use crate::compiled::Compiled;
use crate::material::Material;
use crate::model::{Model, PAPER};
use crate::options::FitOptions;
use crate::passes::{Both, parameters_of, point};
use crate::simd::{AVX2, AVX512, EVERY, SCALAR};

/// What is new in a model is said in its source; all of these are put together from Eq. 5 of the paper.
const EQ_5: &str = "Eq. 5 of Bishop, Butler and Marciniak 2021";

/// `MODELS[0]` is Eq. 14.
pub static MODELS: [Model; 22] = [
    Model {
        name: PAPER,
        what: "Eq. 14: Beckmann, V-groove masking",
        source: "Bishop, Butler and Marciniak 2021, Eq. 14",
        parameters: parameters_of::<Microfacet<ALL>, 6, 6>(),
        terms: ALL,
        point: point::<Microfacet<ALL>, 6, 6>(),
        searches: const { &searches::<Microfacet<ALL>, 6, 6, EVERY>(&EQ_14) },
    },
    microfacet::<ALL, Beckmann, Smith, 6, 8>("beckmann-smith", "Beckmann, Smith masking", "Walter et al. 2007"),
    microfacet::<ALL, Beckmann, NoMasking, 6, 6>("beckmann-unmasked", "Beckmann, no masking", EQ_5),
    microfacet::<{ ALL | OWN_SLOPE }, Beckmann, VGroove, 7, 6>(
        "beckmann-own-slope",
        "Eq. 14, the volume lobe with a slope of its own",
        EQ_5,
    ),
    microfacet::<{ ALL | SECOND }, Beckmann, VGroove, 8, 6>(
        "beckmann-second",
        "Eq. 14 with a second surface lobe",
        EQ_5,
    ),
    microfacet::<ALL, Ggx, VGroove, 6, 6>(
        "ggx",
        "GGX, V-groove masking",
        "Trowbridge and Reitz 1975; Walter et al. 2007, Eq. 33",
    ),
    microfacet::<ALL, Ggx, Smith, 6, 8>("ggx-smith", "GGX, Smith masking", "Walter et al. 2007, Eq. 33 and 34"),
    microfacet::<{ ALL | OWN_SLOPE }, Ggx, VGroove, 7, 6>(
        "ggx-own-slope",
        "GGX, the volume lobe with a slope of its own",
        EQ_5,
    ),
    microfacet::<{ ALL | SECOND }, Ggx, VGroove, 8, 6>("ggx-second", "GGX with a second surface lobe", EQ_5),
    microfacet::<{ ALL | SECOND }, Ggx, Smith, 8, 8>(
        "ggx-smith-second",
        "GGX with a second surface lobe, Smith masking",
        "Walter et al. 2007, Eq. 33 and 34",
    ),
    microfacet::<{ ALL | MIRRORS }, Ggx, VGroove, 7, 6>(
        "ggx-mirrors",
        "GGX with mirrors among the facets of its surface lobe, as flakes of metal are",
        EQ_5,
    ),
    microfacet::<ALL, Exponential, VGroove, 6, 6>(
        "exponential",
        "slopes that fall exponentially, V-groove masking",
        "Holzschuch and Pacanowski 2017",
    ),
    microfacet::<{ ALL | TAIL }, HyperCauchy, VGroove, 7, 6>(
        "hyper-cauchy",
        "a distribution with a free tail, V-groove masking",
        "Renhorn and Boreman 2008",
    ),
    microfacet::<{ ALL | OWN_SLOPE | TAIL }, HyperCauchy, VGroove, 8, 6>(
        "hyper-cauchy-own-slope",
        "a distribution with a free tail, the volume lobe with a slope of its own",
        "Renhorn and Boreman 2008",
    ),
    // The members of Eq. 5 that have names of their own, with the parameters that their authors gave them.
    Model {
        name: "cook-torrance",
        what: "Cook and Torrance's: Eq. 14 without its volume lobe",
        source: "Cook and Torrance 1982",
        parameters: parameters_of::<Microfacet<{ D | S | A }>, 5, 6>(),
        terms: D | S | A,
        point: point::<Microfacet<{ D | S | A }>, 5, 6>(),
        searches: const { &searches::<Microfacet<{ D | S | A }>, 5, 6, AVX512>(&[]) },
    },
    microfacet::<{ D | S | A }, Beckmann, InAngle<VGroove>, 5, 6>(
        "torrance-sparrow",
        "Torrance and Sparrow's: a Gaussian of the facets' tilt in radians, V-groove masking, no volume lobe",
        "Torrance and Sparrow 1967; Blinn 1977",
    ),
    microfacet::<{ D | S }, Ggx, Smith, 4, 8>(
        "walter",
        "Walter's reflection of a dielectric: GGX, Smith masking, no volume lobe, kappa = 0; Lambert's floor is added",
        "Walter, Marschner, Li and Torrance 2007, Eq. 20, 33 and 34",
    ),
    Model::own::<Own<BeardMaxwell>, 7, 8>(
        "beard-maxwell",
        "Beard and Maxwell's for paints: a first surface with shadowing over a volume",
        "Maxwell et al. 1973; Westlund and Meyer 2002, Eq. 10",
    ),
    Model::own::<Own<Abg>, 4, 8>(
        "abg",
        "ABg scatter around the specular direction, Lambert's floor",
        "Pfisterer 2011",
    ),
    Model::own::<Own<HarveyShack>, 4, 8>(
        "harvey-shack",
        "Harvey-Shack scatter with a shoulder, Lambert's floor",
        "Harvey 1976; Pfisterer 2011",
    ),
    Model::own::<Own<KCorrelation>, 4, 8>(
        "k-correlation",
        "roughness of K-correlation spectrum, Lambert's floor",
        "Church and Takacs 1986; Dittman 2006",
    ),
    Model::own::<Own<KCorrelation2>, 7, 8>(
        "k-correlation-2",
        "the same with two terms",
        "Church and Takacs 1986; Dittman 2006",
    ),
];

impl Model {
    /// The paper's model, Eq. 14.
    pub const fn paper() -> &'static Model {
        &MODELS[0]
    }

    /// A model of one's own, from [`brdfit_core::formula::Own`] of a formula or from another [`brdfit_core::model::Model`].
    ///
    /// Everything of the engine takes it: searches, minima, uncertainty, `f32`, joint and robust fits; `examples/own_model.rs` fits one.
    /// `P` is the number of its parameters and `C` that of its numbers a pair of directions, which is 8 for a formula.
    /// Its passes go lane by lane.
    ///
    /// ```
    /// use brdfit_core::formula::Own;
    /// use brdfit_core::models::Abg;
    /// use brdfit_engine::{FitOptions, Model};
    ///
    /// static MINE: Model = Model::own::<Own<Abg>, 4, 8>("mine", "what it is", "where it is from");
    /// assert_eq!(FitOptions::of(&MINE).lower.len(), 4);
    /// ```
    pub const fn own<M: Both<P, C>, const P: usize, const C: usize>(
        name: &'static str,
        what: &'static str,
        source: &'static str,
    ) -> Model {
        Model {
            name,
            what,
            source,
            parameters: parameters_of::<M, P, C>(),
            terms: 0,
            point: point::<M, P, C>(),
            searches: const { &searches::<M, P, C, SCALAR>(&[]) },
        }
    }

    /// The model of this name.
    pub fn find(name: &str) -> Option<&'static Model> {
        MODELS.iter().find(|model| model.name == name)
    }
}

impl Material {
    /// Of the paper's model, Eq. 14, in the order of [`brdfit_core::brdf::NAMES`].
    pub fn paper(values: [f64; 6]) -> Self {
        Material {
            model: Model::paper(),
            values: values.into(),
        }
    }
}

impl Default for FitOptions {
    fn default() -> Self {
        FitOptions::of(Model::paper())
    }
}

/// A model put together from Eq. 5, of which terms can be left out as of Eq. 14.
const fn microfacet<const TERMS: u8, D, M, const P: usize, const C: usize>(
    name: &'static str,
    what: &'static str,
    source: &'static str,
) -> Model
where
    D: Distribution + Send + Sync + 'static,
    M: Masking<D, C> + Send + Sync + 'static,
{
    Model {
        name,
        what,
        source,
        parameters: parameters_of::<Microfacet<TERMS, D, M>, P, C>(),
        terms: TERMS & ALL,
        point: point::<Microfacet<TERMS, D, M>, P, C>(),
        searches: const { &searches::<Microfacet<TERMS, D, M>, P, C, AVX2>(&[]) },
    }
}

const D: u8 = DIFFUSE;
const S: u8 = SURFACE;
const V: u8 = VOLUME;
const A: u8 = ABSORBING;

/// The sets of terms of Eq. 14 that are compiled on their own: what is left out of them costs nothing.
static EQ_14: [Compiled; 7] = [
    eq_14::<D, 1>(),
    eq_14::<{ D | S }, 4>(),
    eq_14::<{ D | S | A }, 5>(),
    eq_14::<{ D | S | V }, 5>(),
    eq_14::<S, 3>(),
    eq_14::<{ S | A }, 4>(),
    eq_14::<{ S | V | A }, 5>(),
];

const fn eq_14<const TERMS: u8, const P: usize>() -> Compiled {
    set::<Microfacet<TERMS>, P, 6, AVX512>(TERMS)
}
