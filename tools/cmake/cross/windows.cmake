# Windows x86-64 by mingw-w64; programs run by Wine.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_CXX_FLAGS_INIT "-w")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static")
# Stripped by the linker and without a time in the header, which strip would write: the same inputs make the same library.
set(CMAKE_SHARED_LINKER_FLAGS_INIT "-static -s -Wl,--no-insert-timestamp")
set(CMAKE_CROSSCOMPILING_EMULATOR wine64)
