//! Links without the start of a program and without names that nobody defines.

fn main() {
    for argument in ["-nostartfiles", "-Wl,-z,defs", "-lc"] {
        println!("cargo:rustc-link-arg={argument}");
    }
}
