//! `wasm-tools module FILE FOLDER NAME` writes what Cargo compiled as `NAME_bg.wasm` into FOLDER, with its JavaScript and types: what
//! `wasm-bindgen --target web` does. `wasm-tools test FILE FOLDER NAME` does the same for a program of tests under Node, with its assertions.

use std::env;
use std::error::Error;

use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [kind, file, folder, name] = arguments.as_slice() else {
        return Err("usage: wasm-tools module|test FILE FOLDER NAME".into());
    };
    let mut bindgen = Bindgen::new();
    match kind.as_str() {
        "module" => bindgen.web(true)?.typescript(true).omit_default_module_path(false),
        // Tests are called one by one: the program itself does not start.
        "test" => bindgen.nodejs(true)?.debug(true).emit_start(false),
        other => return Err(format!("there is no '{other}'").into()),
    };
    Ok(bindgen.input_path(file).out_name(name).generate(folder)?)
}
