"""A real OpenXR runtime without a headset, for tools/xr_e2e."""
