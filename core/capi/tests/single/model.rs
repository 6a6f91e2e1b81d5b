//! The models, and known geometry.

use super::*;

#[test]
fn the_model_gives_the_bits_of_the_host() {
    let params = Params::from_array([0.1, 10.0, 0.01, 0.1, 3.0, 1.0]);
    let x = Scan::<f32, ALL, 6>::coordinates(&params);
    let model = Brdf::<f32, ALL>::new(&params);
    for step in -15..=15 {
        let [theta_i, theta_s, delta_phi] = [0.75, step as f32 * 0.1, step as f32 * 0.3];
        let geometry = Geometry::new(theta_i, theta_s, delta_phi).unwrap();
        let beckmann = Real::portable_exp(model.ln_f(&geometry));
        let ggx = Real::portable_exp(value::<f32, Microfacet<ALL, Ggx>, 6, 6>(&x, geometry.into()));
        assert_ne!(beckmann, ggx);
        let params = params.into();
        // SAFETY: as above.
        unsafe {
            let mut brdf = 0.0;
            let done = brdfit_brdf_f32(theta_i, theta_s, delta_phi, &params, &mut brdf);
            assert_eq!((done, brdf), (Error::None, beckmann));
            for (model, expected) in [(BRDFIT_MODEL_BECKMANN, beckmann), (BRDFIT_MODEL_GGX, ggx)] {
                let done = brdfit_model_brdf_f32(model, theta_i, theta_s, delta_phi, &params, &mut brdf);
                assert_eq!((done, brdf), (Error::None, expected));
            }
        }
    }
}

#[test]
fn a_table_of_geometry_gives_the_bits_of_angles() {
    let memory = with_samples();
    let mut blocks = memory.blocks.clone();
    // SAFETY: as above.
    unsafe {
        let (mut scan, mut geometry): (_, brdfit_geometry<f32>) = (zeroed(), zeroed());
        let (mut found, mut known): (brdfit_found<f32>, brdfit_found<f32>) = (zeroed(), zeroed());
        assert_eq!(brdfit_scan_add_at_f32(&mut scan, &geometry, 1.0, 1.0), Error::NotBegun);
        assert_eq!(
            brdfit_scan_init_f32(&mut scan, blocks.as_mut_ptr(), blocks.len()),
            Error::None
        );
        assert_eq!(
            brdfit_scan_add_at_f32(&mut scan, &geometry, 1.0, 1.0),
            Error::BeyondHorizon
        );
        for sample in samples() {
            let (theta_i, theta_s) = (sample.theta_i as f32, sample.theta_s as f32);
            let done = brdfit_geometry_init_f32(theta_i, theta_s, BRDFIT_PI as f32, &mut geometry);
            assert_eq!(done, Error::None);
            assert_eq!(
                brdfit_scan_add_at_f32(&mut scan, &geometry, 0.0, 1.0),
                Error::NotPositive
            );
            let (brdf, weight) = (sample.brdf as f32, sample.weight as f32);
            assert_eq!(brdfit_scan_add_at_f32(&mut scan, &geometry, brdf, weight), Error::None);
        }
        for (scan, found) in [(&memory.scan, &mut found), (&scan, &mut known)] {
            assert_eq!(brdfit_search_f32(scan, null(), null_mut(), 0, found), Error::None);
        }
        assert_eq!(found, known);
    }
}
