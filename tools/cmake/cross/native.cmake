# This machine, with the dependencies from their sources as on the other targets.
set(CMAKE_CXX_FLAGS_INIT "-w")
