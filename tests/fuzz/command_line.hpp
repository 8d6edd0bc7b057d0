#pragma once

/// Reads the words as one program does, and aborts where what is read is not as the program needs
/// it. Each program has its own.
///
/// Throws : kreisel::InvalidInput
void examine(int argc, char** argv);
