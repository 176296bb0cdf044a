#include <memory>
#include <new>
#include <stdexcept>

#include <zstd.h>

#include "game/net/pack_state.hpp"

namespace handhold {

bool has_packing() { return true; }

std::vector<std::byte> pack_state(std::span<const std::byte> state) {
    constexpr int k_level = 3;
    std::vector<std::byte> out(ZSTD_compressBound(state.size()));
    const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(),
                                                                       ZSTD_freeCCtx);
    if (context == nullptr) {
        throw std::bad_alloc();
    }
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, k_level);
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
    const std::size_t size =
        ZSTD_compress2(context.get(), out.data(), out.size(), state.data(), state.size());
    if (ZSTD_isError(size) != 0) {
        throw std::runtime_error(ZSTD_getErrorName(size));
    }
    out.resize(size);
    return out;
}

std::optional<std::vector<std::byte>> unpack_state(std::span<const std::byte> packed,
                                                   std::size_t most) {
    // Not known and no frame are numbers above any size.
    const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
    if (size == 0 || size > most) {
        return std::nullopt;
    }
    std::vector<std::byte> out(static_cast<std::size_t>(size));
    if (ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size()) != out.size()) {
        return std::nullopt;
    }
    return out;
}

}  // namespace handhold
