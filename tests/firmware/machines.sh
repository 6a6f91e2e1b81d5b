# Which compiler and which emulator; for ./run and ../../core/capi/run, which source it.

# The compilers are chosen here, and so is the folder of what they make.
unset RUSTC RUSTFLAGS CARGO_BUILD_TARGET CARGO_TARGET_DIR CARGO_ENCODED_RUSTFLAGS CARGO_PROFILE_RELEASE_LTO CARGO_PROFILE_RELEASE_CODEGEN_UNITS
# The level from which defmt logs.
export DEFMT_LOG=info

# Options of the compiler for the Cortex-M4F and the Cortex-M7.
m4f="-Z emit-stack-sizes"
m7="-C target-cpu=cortex-m7"

fail() {
    echo "$0: $*" >&2
    exit 1
}

need() {
    command -v "$1" >/dev/null || fail "$1 is missing: install $2"
}

# Sets `cpu` to the seconds of processor time that all ended commands took so far; other jobs on the machine hardly change them.
count_cpu() {
    mkdir -p target
    times >target/times
    cpu=$(awk -F'[ms ]+' 'NR == 2 { printf "%.0f", 60 * ($1 + $3) + $2 + $4 }' target/times)
}

# LLVM's linker, which has its version in its name.
newest() {
    local found
    found=$(compgen -c "$1" | grep -E "^$1(-[0-9]+)?$" | sort -V | tail -n 1)
    [ -n "$found" ] || fail "$1 is missing: install lld-22"
    echo "$found"
}

# Sets `toolchain`, and the environment of cargo, for a target.
choose_toolchain() {
    local target=$1 options=$2 ld
    local name=${target//[-.]/_}
    local variable=CARGO_TARGET_${name^^}
    unset RUSTC RUSTC_BOOTSTRAP
    [[ $options != *-Z* ]] || export RUSTC_BOOTSTRAP=1
    build_std=()
    # An image for Linux or WebAssembly has no C library, from which rustup's would take memcpy.
    if [[ $target == *-none* && -d "$(rustc --print sysroot)/lib/rustlib/$target/lib" ]]; then
        toolchain="$(rustc --version), its library for $target"
    else
        export RUSTC=${DEBIAN_RUSTC:-/usr/bin/rustc}
        [ -x "$RUSTC" ] || fail "no compiler for $target: rustup target add $target, or install Debian's rustc-web and rust-web-src"
        [ -f "$("$RUSTC" --print sysroot)/lib/rustlib/src/rust/library/core/Cargo.toml" ] ||
            fail "$RUSTC has no library source: install rust-web-src"
        export RUSTC_BOOTSTRAP=1
        build_std=(-Zbuild-std=core)
        toolchain="$("$RUSTC" --version), core built from its source"
        # Debian's rust-lld needs a package of its own; GNU's linker does as well.
        case $target in
        thumb*)
            ld=arm-none-eabi-ld
            need $ld binutils-arm-none-eabi
            ;;
        riscv32*)
            ld=riscv64-unknown-elf-ld
            need $ld binutils-riscv64-unknown-elf
            options+=" -C link-arg=-melf32lriscv"
            ;;
        *)
            build_std+=(-Zbuild-std-features=compiler-builtins-mem)
            ;;&
        wasm*)
            ld=$(newest wasm-ld)
            ;;
        *linux*)
            ld=$(newest ld.lld)
            options+=" -C relocation-model=static"
            ;;
        esac
        export "${variable}_LINKER=$ld"
        [[ $target == wasm* ]] || options+=" -C linker-flavor=ld"
    fi
    export "${variable}_RUSTFLAGS=$options"
}

# Runs an image with arguments.
emulate() {
    local machine=$1 image=$2
    shift 2
    local run=()
    case $machine in
    node)
        need node nodejs
        run=(node "$machines_folder/src/outside/node.mjs")
        ;;
    i686)
        # A processor of today runs it as it is.
        [ "$(uname -m)" = x86_64 ] || run=(qemu-i386)
        ;;
    aarch64 | s390x) run=("qemu-$machine") ;;
    virt*)
        run=(qemu-system-riscv32 -bios none -M virt)
        # Without the instructions for atomics and floating point that this machine has otherwise.
        [ "$machine" != virt-imc ] || run+=(-cpu "rv32,a=false,f=false,d=false")
        ;;
    *) run=(qemu-system-arm -M "$machine") ;;
    esac
    case ${run[0]-} in
    qemu-system-riscv32) need "${run[0]}" qemu-system-misc ;;
    qemu-system-arm) need "${run[0]}" qemu-system-arm ;;
    qemu-*) need "${run[0]}" qemu-user ;;
    esac
    if [[ ${run[0]-} != qemu-system-* ]]; then
        timeout "${TIMEOUT:-300}" "${run[@]}" "$image" "$@" </dev/null
        return
    fi
    # The image's name, then its arguments.
    local semihosting=enable=on,target=native argument
    for argument in firmware "$@"; do
        semihosting+=,arg=$argument
    done
    timeout "${TIMEOUT:-300}" "${run[@]}" "${emulator_options[@]}" -nographic -monitor none -serial none \
        -semihosting-config "$semihosting" -kernel "$image" </dev/null
}

machines_folder=$PWD

# Most stack below a call, in bytes: of an image and a part of the function's name, from the compiler's sizes of frames and the calls in the image.
deepest_in() {
    arm-none-eabi-objcopy -O binary --only-section=.stack_sizes --set-section-flags .stack_sizes=alloc "$1" "$1.stack_sizes"
    {
        od -An -v -tu1 -w1 "$1.stack_sizes"
        echo code
        arm-none-eabi-objdump -d --no-show-raw-insn "$1"
    } | awk -v root="$2" -f "$machines_folder/deepest.awk"
}
