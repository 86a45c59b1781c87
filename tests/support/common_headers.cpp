// The compiler makes the precompiled header for this file.
