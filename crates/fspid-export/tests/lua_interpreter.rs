//! Lua 5.3, built from the sources that the crate `lua-src` carries, with numbers of 32 and of 64 bits.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

use fspid_export::program::Precision;

/// Runs one file; messages go to where errors go.
const HOST: &str = r#"
#include <stdio.h>
#include "lua.h"
#include "lualib.h"
#include "lauxlib.h"

int main(int count, char **words)
{
    lua_State *lua = luaL_newstate();
    luaL_openlibs(lua);
    if (count != 2 || luaL_dofile(lua, words[1])) {
        fprintf(stderr, "%s\n", lua_tostring(lua, -1));
        return 1;
    }
    lua_close(lua);
    return 0;
}
"#;

static SINGLE: LazyLock<PathBuf> = LazyLock::new(|| built("lua-32-bits", &["-DLUA_32BITS"]));
static DOUBLE: LazyLock<PathBuf> = LazyLock::new(|| built("lua-64-bits", &[]));

/// Runs a file of a folder, which is where it finds its modules.
pub(crate) fn run(precision: Precision, folder: &Path, file: &str) -> Output {
    let program = match precision {
        Precision::Single => &*SINGLE,
        Precision::Double => &*DOUBLE,
    };
    let mut command = Command::new(program);
    command.arg(file).current_dir(folder).env("LUA_PATH_5_3", "./?.lua");
    command.output().expect("Lua runs")
}

/// What it printed; it must have ended well.
pub(crate) fn printed(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// The interpreter, which is built once in a folder of built things.
fn built(name: &str, flags: &[&str]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let program = folder.join(name);
    if program.exists() {
        return program;
    }
    let sources = sources();
    let host = folder.join(format!("{name}.c"));
    std::fs::write(&host, HOST).expect("a temporary file");
    let files = std::fs::read_dir(&sources).expect("the sources of Lua");
    let files = files.map(|entry| entry.expect("a source").path());
    let files = files.filter(|file| file.extension().is_some_and(|ending| ending == "c"));
    // Beside the place first, so that what is there is whole.
    let half = folder.join(format!("{name}.{}", std::process::id()));
    let mut compiler = Command::new("cc");
    compiler.args(["-std=gnu99", "-O1", "-w"]).args(flags).arg("-I").arg(&sources);
    let output = compiler.args(files).arg(&host).arg("-o").arg(&half).arg("-lm").output();
    let output = output.expect("the compiler that links Rust");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    std::fs::rename(&half, &program).expect("the same folder");
    program
}

/// Where the crate has the sources of Lua 5.3: beside its own, whose place cargo notes next to what it builds.
fn sources() -> PathBuf {
    let program = std::env::current_exe().expect("the program of this test");
    let built = std::fs::read_dir(program.parent().expect("a folder")).expect("what is built");
    let notes = built.map(|entry| entry.expect("what is built").path());
    let notes = notes.filter(|path| {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        name.starts_with("lua_src-") && name.ends_with(".d")
    });
    let texts = notes.map(|path| std::fs::read_to_string(path).expect("a note"));
    let texts: Vec<String> = texts.map(|text| text.replace("\\ ", " ")).collect();
    let lines = texts.iter().flat_map(|text| text.lines());
    let folders = lines.filter_map(|line| line.strip_suffix("src/lib.rs:"));
    let mut sources = folders.map(|folder| Path::new(folder).join("lua-5.3.6"));
    sources.find(|folder| folder.is_dir()).expect("Lua 5.3.6 in the crate lua-src")
}
