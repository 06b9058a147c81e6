"""Mutation testing of kernels/ and engine/: see tools/mutate."""
