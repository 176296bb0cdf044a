# WebAssembly by Debian's emscripten. Environment: see tools/cross.
include(/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
# Without automatic vectors of scalar sums: Clang 14 then adds a component of a dot product twice (decision 144).
set(CMAKE_CXX_FLAGS_INIT "-w -msimd128 -fwasm-exceptions -fno-slp-vectorize -include ${CMAKE_CURRENT_LIST_DIR}/web_shim.hpp")
set(CMAKE_C_FLAGS_INIT "-w -msimd128")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-fwasm-exceptions")
# The module is downloaded. FORCE, so that older build folders get these flags too: emscripten adds -fno-inline-functions to -Os and -Oz, without which Eigen's small functions are calls (decision 154).
set(CMAKE_CXX_FLAGS_RELEASE "-Os -finline-functions -DNDEBUG" CACHE STRING "" FORCE)
set(CMAKE_C_FLAGS_RELEASE "-Os -finline-functions -DNDEBUG" CACHE STRING "" FORCE)
