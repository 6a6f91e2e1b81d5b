# Which compiler and which emulator; for ./run and ../../core/capi/run, which source it.

# The compilers are chosen here, and so is the folder of what they make.
unset RUSTC RUSTFLAGS CARGO_BUILD_TARGET CARGO_TARGET_DIR CARGO_ENCODED_RUSTFLAGS CARGO_PROFILE_RELEASE_LTO CARGO_PROFILE_RELEASE_CODEGEN_UNITS
# The level from which defmt logs.
export DEFMT_LOG=info

fail() {
    echo "$0: $*" >&2
    exit 1
}

need() {
    command -v "$1" >/dev/null || fail "$1 is missing: install $2"
}

# Sets `toolchain`, and the environment of cargo, for a target.
choose_toolchain() {
    local target=$1 options=$2 ld
    local name=${target//[-.]/_}
    local variable=CARGO_TARGET_${name^^}
    unset RUSTC RUSTC_BOOTSTRAP
    [[ $options != *-Z* ]] || export RUSTC_BOOTSTRAP=1
    build_std=()
    if [ -d "$(rustc --print sysroot)/lib/rustlib/$target/lib" ]; then
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
        esac
        export "${variable}_LINKER=$ld"
        options+=" -C linker-flavor=ld"
    fi
    export "${variable}_RUSTFLAGS=$options"
}

# Runs an image with arguments.
emulate() {
    local machine=$1 image=$2 emulator=qemu-system-arm extra=() arguments=firmware
    shift 2
    if [ "$machine" = virt ]; then
        emulator=qemu-system-riscv32
        extra=(-bios none)
        need $emulator qemu-system-misc
    else
        need $emulator qemu-system-arm
    fi
    # The image's name, then its arguments.
    local semihosting=enable=on,target=native
    for argument in "$arguments" "$@"; do
        semihosting+=,arg=$argument
    done
    timeout "${TIMEOUT:-300}" "$emulator" -M "$machine" "${extra[@]}" "${emulator_options[@]}" -nographic -monitor none -serial none \
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
