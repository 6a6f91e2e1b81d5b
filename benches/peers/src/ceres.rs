//! Ceres through its C interface, which has no bounds: trust region with its own defaults.

use std::ffi::{c_double, c_int, c_void};

use crate::course::Course;
use crate::fits::Free;

#[repr(C)]
struct Problem {
    _private: [u8; 0],
}

type Cost = unsafe extern "C" fn(*mut c_void, *mut *mut c_double, *mut c_double, *mut *mut c_double) -> c_int;

unsafe extern "C" {
    fn ceres_init();
    fn ceres_create_problem() -> *mut Problem;
    fn ceres_free_problem(problem: *mut Problem);
    fn ceres_problem_add_residual_block(
        problem: *mut Problem,
        cost: Cost,
        user: *mut c_void,
        loss: *mut c_void,
        loss_user: *mut c_void,
        residuals: c_int,
        blocks: c_int,
        sizes: *mut c_int,
        parameters: *mut *mut c_double,
    ) -> *mut c_void;
    fn ceres_solve(problem: *mut Problem);
}

/// Residuals and, where they are wanted, their derivatives.
unsafe extern "C" fn cost(
    user: *mut c_void,
    parameters: *mut *mut c_double,
    residuals: *mut c_double,
    jacobians: *mut *mut c_double,
) -> c_int {
    // SAFETY: Ceres hands back the course that `ceres` gave it, and arrays of the sizes that it was told.
    unsafe {
        let course = &*user.cast::<Course>();
        let free = Free {
            course,
            u: std::slice::from_raw_parts(*parameters, 6).to_vec(),
        };
        let out = std::slice::from_raw_parts_mut(residuals, course.rows());
        if jacobians.is_null() || (*jacobians).is_null() {
            out.copy_from_slice(&course.residuals(&free.x()));
        } else {
            let (values, gradients) = free.linearized();
            out.copy_from_slice(&values);
            std::slice::from_raw_parts_mut(*jacobians, 6 * course.rows()).copy_from_slice(gradients.as_flattened());
        }
    }
    // Ceres ends where a cost cannot be computed.
    c_int::from(!unsafe { &*user.cast::<Course>() }.is_over())
}

pub fn ceres(course: &Course, start: &[f64; 6]) {
    static ONCE: std::sync::Once = std::sync::Once::new();
    let mut u = Free::begin(course, start).u;
    let (mut size, mut block) = (6, u.as_mut_ptr());
    // SAFETY: all that Ceres is given lives until it is done.
    unsafe {
        ONCE.call_once(|| ceres_init());
        let problem = ceres_create_problem();
        ceres_problem_add_residual_block(
            problem,
            cost,
            std::ptr::from_ref(course).cast_mut().cast(),
            std::ptr::null_mut(),
            std::ptr::null_mut(),
            course.rows() as c_int,
            1,
            &mut size,
            &mut block,
        );
        ceres_solve(problem);
        ceres_free_problem(problem);
    }
}
