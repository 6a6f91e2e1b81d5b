//! Ceres takes part where Debian's libceres-dev is installed.

fn main() {
    println!("cargo:rustc-check-cfg=cfg(ceres)");
    if std::path::Path::new("/usr/include/ceres/c_api.h").exists() {
        println!("cargo:rustc-cfg=ceres");
        println!("cargo:rustc-link-lib=ceres");
    }
}
