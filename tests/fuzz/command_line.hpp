#pragma once

/// Reads the words as one program does. Aborts if the result violates the program's requirements.
/// Each program has its own version.
///
/// Throws : kreisel::InvalidInput
void examine(int argc, char** argv);
