# What tools/cross and tools/package share: Debian's packages, the dependencies' sources, the build, and how programs run. To be sourced in the
# repository's folder, whose path is `root`. A TARGET is web, arm64, windows or native.

# needs_packages SCRIPT SET INSTALLS: exit status 77 if packages of this set of tools/install_packages are missing, or if that cannot be known,
# and INSTALLS is not true. SCRIPT: who asks.
needs_packages() {
    local missing
    ! $3 || tools/install_packages "$2"
    missing=$(tools/install_packages --missing "$2") || exit
    [[ -z $missing ]] || { echo "$1: not installed: $missing (tools/install_packages $2)" >&2; exit 77; }
}

# The dependencies' sources, from the distribution's source packages, with its patches. apt gets its own list of sources, made from the
# machine's Debian repositories: theirs usually omit source packages.
sources=${HANDHOLD_CROSS_SOURCES:-$root/build/cross/sources}
fetch_sources() {
    local apt=$sources/apt options package
    [[ ! -e $sources/complete ]] || return 0
    rm -rf "$sources"
    mkdir -p "$apt/lists/partial" "$sources/include"
    apt-get indextargets --format 'deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $(REPO_URI) $(RELEASE) $(COMPONENT)' \
        'Created-By: Packages' 'Origin: Debian' | sort -u >"$apt/sources.list"
    options=(-qq -o "Dir::Etc::sourcelist=$apt/sources.list" -o Dir::Etc::sourceparts=- -o "Dir::State::lists=$apt/lists"
        -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= -o APT::Sandbox::User=root)
    apt-get "${options[@]}" update
    for package in bullet box2d meshoptimizer; do
        (cd "$apt" && apt-get "${options[@]}" source --download-only "$package")
        dpkg-source --no-check --extract "$(ls "$apt/$package"_*.dsc)" "$sources/$package" >/dev/null
    done
    ln -s /usr/include/eigen3/Eigen "$sources/include/Eigen"
    ln -s /usr/include/nlohmann "$sources/include/nlohmann"
    ln -s ../box2d/include/box2d "$sources/include/box2d"
    ln -s ../meshoptimizer/src/meshoptimizer.h "$sources/include/meshoptimizer.h"
    touch "$sources/complete"
}

# Emscripten makes its system libraries when they are first needed, in its own cache.
export EM_CACHE=${EM_CACHE:-$root/build/cross/emscripten_cache} EM_FROZEN_CACHE='' NODE_PATH=/usr/share/nodejs

# build_targets TARGET TESTS CMAKE_TARGET...: builds in build/cross/TARGET. TESTS: ON or OFF.
build_targets() {
    local folder=build/cross/$1 built=$1 tests=$2 shared=ON
    shift 2
    [[ $built != web ]] || shared=OFF
    mkdir -p build/cross
    fetch_sources
    cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_TOOLCHAIN_FILE="$root/tools/cmake/cross/$built.cmake" \
        -DHANDHOLD_SOURCES="$sources" -DHANDHOLD_BUILD_PORTABILITY=ON -DHANDHOLD_BUILD_GAME=OFF -DBUILD_SHARED_LIBS=$shared \
        -DHANDHOLD_BUILD_TESTS="$tests" -DHANDHOLD_BUILD_BENCH=OFF -DHANDHOLD_WERROR=OFF \
        -DHANDHOLD_PRECOMPILE=OFF -DHANDHOLD_THREADS=OFF -DHANDHOLD_HAS_DRACO=OFF \
        >"$folder.log" 2>&1 || { tail -n 20 "$folder.log" >&2; return 1; }
    cmake --build "$folder" -j2 --target "$@" >>"$folder.log" 2>&1 || { grep -A5 -m3 'error' "$folder.log" >&2; return 1; }
}

# The npm package: the JavaScript sources, what was generated from the headers, and the library.
make_npm_package() {
    local package=build/cross/web/package
    rm -rf "$package"
    mkdir -p "$package"
    cp game/web/package/{package.json,README.md} game/web/package/src/* LICENSE build/cross/web/bin/handhold{,-core}.wasm "$package"
    python3 -B systems/host/bindings/generate.py --check
    cp systems/host/bindings/javascript/* "$package"
    local module
    for module in handhold handhold-core; do
        printf '%s.wasm: %d bytes, %d gzipped\n' $module "$(stat -c %s "$package/$module.wasm")" "$(gzip -9c "$package/$module.wasm" | wc -c)"
    done
}

# choose_runner TARGET: sets `run`, the command before a program of the target on this machine, and `suffix`, how the program's name ends.
choose_runner() {
    run=() suffix=""
    case $1 in
        web) run=(node --no-experimental-fetch) suffix=.js ;;
        arm64) run=(qemu-aarch64-static -L /usr/aarch64-linux-gnu) ;; # where the cross compiler's C library is
        windows) # Debian's wine64 is outside the path without the package wine. Wine keeps its settings in a folder.
            run=(env WINEDEBUG=-all WINEPREFIX="$root/build/cross/wine" DISPLAY= "$(command -v wine64 || echo /usr/lib/wine/wine64)") suffix=.exe ;;
    esac
}
