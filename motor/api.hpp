#pragma once

/// Marks a function or class of the public interface that is compiled into libkreisel. All other
/// symbols of the library are hidden.
#if defined(__GNUC__)
#define KREISEL_API [[gnu::visibility("default")]]
#else
#define KREISEL_API
#endif
