#include "depthgrid/files/mcap_compression.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"

namespace depthgrid::files {
namespace {

constexpr int kZstdLevel = 1;
/// What is decompressed at a time.
constexpr std::size_t kBlockBytes = std::size_t{1} << 20U;

struct FreeZstd {
  void operator()(ZSTD_DCtx* context) const noexcept { static_cast<void>(ZSTD_freeDCtx(context)); }
};
struct FreeLz4 {
  void operator()(LZ4F_dctx* context) const noexcept { static_cast<void>(LZ4F_freeDecompressionContext(context)); }
};

/// `step(in, out)` decompresses some and takes what it used off `in`; it gives the bytes written.
template <class Step>
void decompress_in_steps(std::span<const std::byte> in, std::size_t size, std::vector<std::byte>& out,
                         std::string_view context, const Step& step) {
  out.clear();
  for (;;) {
    const std::size_t begin = out.size();
    // A byte more than is promised, to see whether more comes.
    out.resize(begin + std::min(kBlockBytes, size + 1 - begin));
    const std::size_t before = in.size();
    const std::size_t written = step(in, std::span(out).subspan(begin));
    out.resize(begin + written);
    if (out.size() > size || (written == 0 && in.size() == before)) {
      break;
    }
  }
  if (out.size() != size) {
    fail(context, ": broken: its data has ", out.size() > size ? "more than " : "only ", std::min(out.size(), size),
         " bytes, ", size, " are promised");
  }
}

void decompress_zstd(std::span<const std::byte> in, std::size_t size, std::vector<std::byte>& out,
                     std::string_view context) {
  const std::unique_ptr<ZSTD_DCtx, FreeZstd> zstd(ZSTD_createDCtx());
  if (!zstd) {
    fail(context, ": zstd could not be started (out of memory?)");
  }
  decompress_in_steps(in, size, out, context, [&](std::span<const std::byte>& from, std::span<std::byte> to) {
    ZSTD_inBuffer input{from.data(), from.size(), 0};
    ZSTD_outBuffer output{to.data(), to.size(), 0};
    const std::size_t result = ZSTD_decompressStream(zstd.get(), &output, &input);
    if (ZSTD_isError(result) != 0) {
      fail(context, ": broken zstd data: ", ZSTD_getErrorName(result));
    }
    from = from.subspan(input.pos);
    return output.pos;
  });
}

void decompress_lz4(std::span<const std::byte> in, std::size_t size, std::vector<std::byte>& out,
                    std::string_view context) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0) {
    fail(context, ": LZ4 could not be started (out of memory?)");
  }
  const std::unique_ptr<LZ4F_dctx, FreeLz4> lz4(made);
  decompress_in_steps(in, size, out, context, [&](std::span<const std::byte>& from, std::span<std::byte> to) {
    std::size_t taken = from.size();
    std::size_t written = to.size();
    const std::size_t result = LZ4F_decompress(lz4.get(), to.data(), &written, from.data(), &taken, nullptr);
    if (LZ4F_isError(result) != 0) {
      fail(context, ": broken LZ4 data: ", LZ4F_getErrorName(result));
    }
    from = from.subspan(taken);
    return written;
  });
}

}  // namespace

std::string_view mcap_name(McapCompression compression) noexcept {
  switch (compression) {
    case McapCompression::zstd:
      return "zstd";
    case McapCompression::lz4:
      return "lz4";
    default:
      return "";
  }
}

void mcap_compress(McapCompression compression, std::span<const std::byte> in, std::vector<std::byte>& out) {
  if (compression == McapCompression::zstd) {
    out.resize(ZSTD_compressBound(in.size()));
    const std::size_t size = ZSTD_compress(out.data(), out.size(), in.data(), in.size(), kZstdLevel);
    if (ZSTD_isError(size) != 0) {
      fail("zstd: ", ZSTD_getErrorName(size));
    }
    out.resize(size);
  } else if (compression == McapCompression::lz4) {
    out.resize(LZ4F_compressFrameBound(in.size(), nullptr));
    const std::size_t size = LZ4F_compressFrame(out.data(), out.size(), in.data(), in.size(), nullptr);
    if (LZ4F_isError(size) != 0) {
      fail("LZ4: ", LZ4F_getErrorName(size));
    }
    out.resize(size);
  } else {
    out.assign(in.begin(), in.end());
  }
}

void mcap_decompress(std::string_view name, std::span<const std::byte> in, std::size_t size,
                     std::vector<std::byte>& out, std::string_view context) {
  if (name == "zstd") {
    decompress_zstd(in, size, out, context);
  } else if (name == "lz4") {
    decompress_lz4(in, size, out, context);
  } else if (name.empty()) {
    if (in.size() != size) {
      fail(context, ": broken: its data has ", in.size(), " bytes, ", size, " are promised");
    }
    out.assign(in.begin(), in.end());
  } else {
    fail(context, ": is compressed with '", printable_excerpt(name), "', known are zstd, lz4 and none");
  }
}

}  // namespace depthgrid::files
