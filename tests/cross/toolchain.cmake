# Cross compilers of Debian for the machine KREISEL_MACHINE, whose programs qemu runs.
set(KREISEL_MACHINE "" CACHE STRING "arm64, armhf, i386 or s390x")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES KREISEL_MACHINE)

if(KREISEL_MACHINE STREQUAL arm64)
  set(CMAKE_SYSTEM_PROCESSOR aarch64)
  set(triplet aarch64-linux-gnu)
elseif(KREISEL_MACHINE STREQUAL armhf)
  set(CMAKE_SYSTEM_PROCESSOR arm)
  set(triplet arm-linux-gnueabihf)
elseif(KREISEL_MACHINE STREQUAL i386)
  set(CMAKE_SYSTEM_PROCESSOR i386)
  set(triplet i686-linux-gnu)
  # The registers of the 8087 round to 64 bits and again to 53: no sum of theirs has a known error.
  set(CMAKE_CXX_FLAGS_INIT "-msse2 -mfpmath=sse")
elseif(KREISEL_MACHINE STREQUAL s390x)
  set(CMAKE_SYSTEM_PROCESSOR s390x)
  set(triplet s390x-linux-gnu)
else()
  message(FATAL_ERROR "KREISEL_MACHINE is '${KREISEL_MACHINE}': give arm64, armhf, i386 or s390x")
endif()

if(KREISEL_MACHINE MATCHES "^arm")
  string(APPEND CMAKE_CXX_FLAGS_INIT " -Wno-psabi") # notes on calls between old compilers
endif()

set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_CXX_COMPILER ${triplet}-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-${CMAKE_SYSTEM_PROCESSOR} -L /usr/${triplet})
