//! Scans that the default search missed once, and the least cost that any method found: it finds them.

use brdfit_core::search::CANDIDATES;
use brdfit_suite::hard_scenes::Kind;
use brdfit_suite::missed::{MISSED, ended};

/// Of version 0.2.0's first search, with a seed of 0 to 2.
const BY_THE_FIRST: [(Kind, u64, f64); 18] = [
    (Kind::Mirror, 20, 1.291_217_30e0),
    (Kind::Mirror, 29, 4.513_016_21e-2),
    (Kind::Mirror, 53, 2.998_329_58e-3),
    (Kind::Mirror, 126, 2.203_464_52e-2),
    (Kind::Mirror, 160, 1.252_986_99e-2),
    (Kind::Mirror, 178, 1.587_051_58e-2),
    (Kind::Mirror, 243, 2.146_134_60e-1),
    (Kind::Mirror, 357, 2.673_042_94e-3),
    (Kind::Mirror, 359, 5.001_478_27e-1),
    (Kind::Rough, 133, 2.935_491_10e-3),
    (Kind::Rough, 168, 1.455_993_24e-1),
    (Kind::Rough, 352, 2.370_456_66e-2),
    (Kind::Misfit, 308, 3.658_408_27e-2),
    (Kind::Walk, 123, 7.718_959_54e0),
    (Kind::Bounded, 278, 2.676_148_75e-1),
    (Kind::Sparse, 21, 3.884_132_81e-2),
    (Kind::Sparse, 184, 2.996_305_23e-4),
    (Kind::Needle, 2, 2.035_262_38e1),
];
/// Of its second: settled too early where the model follows the scan badly, or where another index of refraction is better by a little.
const BY_THE_SECOND: [(Kind, u64, f64); 8] = [
    (Kind::New, 559, 4.943_987_36e-2),
    (Kind::Rough, 424, 1.406_625_94e-2),
    (Kind::Misfit, 322, 7.742_005_15e2),
    (Kind::Walk, 9, 4.152_010_03e-1),
    (Kind::Walk, 542, 2.235_718_36e3),
    (Kind::Needle, 311, 4.797_004_87e1),
    (Kind::Needle, 528, 1.099_050_85e2),
    (Kind::Single, 193, 4.252_658_07e2),
];

/// Of its third: basins that differ by a thousandth where the model does not follow the scan, and weights near their bounds.
const BY_THE_THIRD: [(Kind, u64, f64); 4] = [
    (Kind::Walk, 350, 7.977_121_70e0),
    (Kind::Walk, 413, 6.276_229_86e2),
    (Kind::Walk, 508, 8.845_075_27e2),
    (Kind::Needle, 275, 3.124_965_03e1),
];

/// Of its fourth: a valley in which the last fit ended on its limit of passes.
const BY_THE_FOURTH: [(Kind, u64, f64); 1] = [(Kind::Bounded, 343, 1.410_891_11e-2)];

fn finds(scans: &[(Kind, u64, f64)]) {
    for &(kind, k, least) in scans {
        for seed in 0..3 {
            let excess = ended(kind, k, seed, CANDIDATES, least).cost / least - 1.0;
            assert!(
                excess < MISSED,
                "{kind:?} {k}, seed {seed}: {excess:.1e} above the optimum"
            );
        }
    }
}

#[test]
fn what_the_first_search_missed_is_found() {
    finds(&BY_THE_FIRST);
}

#[test]
fn what_the_second_search_missed_is_found() {
    finds(&BY_THE_SECOND);
}

#[test]
fn what_the_third_search_missed_is_found() {
    finds(&BY_THE_THIRD);
}

#[test]
fn what_the_fourth_search_missed_is_found() {
    finds(&BY_THE_FOURTH);
}
