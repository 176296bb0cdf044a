#include <algorithm>
#include <memory>
#include <new>
#include <stdexcept>
#include <utility>

#include <zstd.h>

#include "game/net/pack_state.hpp"

namespace handhold {

namespace {

void check_zstd(std::size_t result) {
    if (ZSTD_isError(result) != 0) {
        throw std::runtime_error(ZSTD_getErrorName(result));
    }
}

class ZstdPacker final : public StatePacker {
  public:
    explicit ZstdPacker(std::vector<std::byte> state)
        : state_(std::move(state)), context_(ZSTD_createCCtx(), ZSTD_freeCCtx) {
        constexpr int k_level = 3;
        packed_.reserve(ZSTD_compressBound(state_.size()));
        if (context_ == nullptr) {
            throw std::bad_alloc();
        }
        ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, k_level);
        ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_checksumFlag, 1);
        check_zstd(ZSTD_CCtx_setPledgedSrcSize(context_.get(), state_.size()));
    }

    std::size_t advance(std::size_t bytes) override {
        const std::size_t before = read_;
        // Room for the part and for what zstd has kept of those before. Grows by parts, because all
        // of the memory at once would take a tick's time to clear.
        const std::size_t room = ZSTD_compressBound(bytes) + ZSTD_CStreamOutSize();
        packed_.resize(std::min(packed_.capacity(), written_ + room));
        ZSTD_inBuffer in = {state_.data(), std::min(state_.size(), read_ + bytes), read_};
        ZSTD_outBuffer out = {packed_.data(), packed_.size(), written_};
        const bool is_last = in.size == state_.size();
        const std::size_t left =
            ZSTD_compressStream2(context_.get(), &out, &in, is_last ? ZSTD_e_end : ZSTD_e_continue);
        check_zstd(left);
        read_ = in.pos;
        written_ = out.pos;
        is_done_ = is_last && left == 0;
        return read_ - before;
    }
    bool is_done() const override { return is_done_; }
    std::vector<std::byte> take() override {
        packed_.resize(written_);
        return std::move(packed_);
    }

  private:
    std::vector<std::byte> state_;
    std::vector<std::byte> packed_;
    std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context_;
    std::size_t read_ = 0;
    std::size_t written_ = 0;
    bool is_done_ = false;
};

}  // namespace

bool has_packing() { return true; }

std::unique_ptr<StatePacker> StatePacker::begin(std::vector<std::byte> state) {
    return std::make_unique<ZstdPacker>(std::move(state));
}

std::vector<std::byte> pack_state(std::vector<std::byte> state) {
    const std::size_t size = state.size();
    ZstdPacker packer(std::move(state));
    while (!packer.is_done()) {
        packer.advance(size);
    }
    return packer.take();
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
