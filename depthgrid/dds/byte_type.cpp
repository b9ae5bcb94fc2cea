#include "depthgrid/dds/byte_type.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>

namespace depthgrid::dds {
namespace {

/// Readers may copy up to a multiple of four bytes.
constexpr std::size_t padded(std::size_t size) noexcept { return (size + 3) / 4 * 4; }

/// Cyclone counts who holds it and calls free_message() at the last. `c` comes first: a pointer to one is one to both.
struct ByteMessage {
  ddsi_serdata c{};
  std::size_t size = 0;
  std::vector<std::byte> bytes;  ///< padded
};

struct ByteType {
  ddsi_sertype c{};
};

const ByteMessage& as_bytes(const ddsi_serdata* message) { return *reinterpret_cast<const ByteMessage*>(message); }

/// Null where there is no memory: these are called by C.
ByteMessage* new_message(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) noexcept {
  try {
    auto message = std::make_unique<ByteMessage>();
    ddsi_serdata_init(&message->c, type, kind);
    message->size = size;
    message->bytes.resize(padded(size));
    return message.release();
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

ddsi_serdata* released(ByteMessage* message) noexcept { return message == nullptr ? nullptr : &message->c; }

// Without keys all messages of a type are of one instance.
bool equal_keys(const ddsi_serdata* /*a*/, const ddsi_serdata* /*b*/) { return true; }

std::uint32_t size_of(const ddsi_serdata* message) { return static_cast<std::uint32_t>(as_bytes(message).size); }

/// Of what came in fragments, which may overlap.
ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* fragment,
                             std::size_t size) {
  ByteMessage* message = new_message(type, kind, size);
  std::size_t done = 0;
  for (; message != nullptr && fragment != nullptr; fragment = fragment->nextfrag) {
    const std::size_t end = std::min<std::size_t>(fragment->maxp1, size);
    if (end > done) {
      const unsigned char* payload = NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
      std::memcpy(message->bytes.data() + done, payload + (done - fragment->min), end - done);
      done = end;
    }
  }
  return released(message);
}

ddsi_serdata* from_pieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                          const ddsrt_iovec_t* pieces, std::size_t size) {
  ByteMessage* message = new_message(type, kind, size);
  std::size_t done = 0;
  for (std::size_t n = 0; message != nullptr && n < static_cast<std::size_t>(count); ++n) {
    const std::size_t length = std::min<std::size_t>(pieces[n].iov_len, size - done);
    std::memcpy(message->bytes.data() + done, pieces[n].iov_base, length);
    done += length;
  }
  return released(message);
}

ddsi_serdata* from_keyhash(const ddsi_sertype* type, const ddsi_keyhash* /*hash*/) {
  return released(new_message(type, SDK_KEY, 0));
}

/// Nothing here is written as a sample.
ddsi_serdata* from_sample(const ddsi_sertype* /*type*/, ddsi_serdata_kind /*kind*/, const void* /*sample*/) {
  return nullptr;
}

void to_bytes(const ddsi_serdata* message, std::size_t begin, std::size_t size, void* to) {
  std::memcpy(to, as_bytes(message).bytes.data() + begin, size);
}

ddsi_serdata* borrow_bytes(const ddsi_serdata* message, std::size_t begin, std::size_t size, ddsrt_iovec_t* to) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): C's iovec serves reading and writing; this is read
  to->iov_base = const_cast<std::byte*>(as_bytes(message).bytes.data() + begin);
  to->iov_len = size;
  return ddsi_serdata_ref(message);
}

void return_bytes(ddsi_serdata* message, const ddsrt_iovec_t* /*borrowed*/) { ddsi_serdata_unref(message); }

bool to_sample(const ddsi_serdata* /*message*/, void* /*sample*/, void** /*memory*/, void* /*end*/) { return false; }

/// What stands for the instance.
ddsi_serdata* to_untyped(const ddsi_serdata* message) {
  ByteMessage* key = new_message(message->type, SDK_KEY, 0);
  if (key != nullptr) {
    key->c.type = nullptr;
  }
  return released(key);
}

bool untyped_to_sample(const ddsi_sertype* /*type*/, const ddsi_serdata* /*message*/, void* /*sample*/,
                       void** /*memory*/, void* /*end*/) {
  return true;
}

void free_message(ddsi_serdata* message) { delete reinterpret_cast<ByteMessage*>(message); }

std::size_t print(const ddsi_sertype* /*type*/, const ddsi_serdata* /*message*/, char* to, std::size_t size) {
  if (size > 0) {
    to[0] = '\0';
  }
  return 0;
}

void keyhash(const ddsi_serdata* /*message*/, ddsi_keyhash* hash, bool /*md5*/) { std::memset(hash, 0, sizeof(*hash)); }

constexpr ddsi_serdata_ops make_message_operations() {
  ddsi_serdata_ops ops{};
  ops.eqkey = equal_keys;
  ops.get_size = size_of;
  ops.from_ser = from_fragments;
  ops.from_ser_iov = from_pieces;
  ops.from_keyhash = from_keyhash;
  ops.from_sample = from_sample;
  ops.to_ser = to_bytes;
  ops.to_ser_ref = borrow_bytes;
  ops.to_ser_unref = return_bytes;
  ops.to_sample = to_sample;
  ops.to_untyped = to_untyped;
  ops.untyped_to_sample = untyped_to_sample;
  ops.free = free_message;
  ops.print = print;
  ops.get_keyhash = keyhash;
  return ops;
}

const ddsi_serdata_ops kMessageOperations = make_message_operations();

void free_type(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete reinterpret_cast<ByteType*>(type);
}

// Samples are not used, and types of one name are one.
void zero_samples(const ddsi_sertype* /*type*/, void* /*samples*/, std::size_t /*count*/) {}
void realloc_samples(void** /*pointers*/, const ddsi_sertype* /*type*/, void* /*old*/, std::size_t /*old_count*/,
                     std::size_t /*count*/) {}
void free_samples(const ddsi_sertype* /*type*/, void** /*pointers*/, std::size_t /*count*/, dds_free_op_t /*op*/) {}
bool equal_types(const ddsi_sertype* /*a*/, const ddsi_sertype* /*b*/) { return true; }
std::uint32_t hash_type(const ddsi_sertype* /*type*/) { return 0; }

ddsi_sertype_ops make_type_operations() {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = free_type;
  ops.zero_samples = zero_samples;
  ops.realloc_samples = realloc_samples;
  ops.free_samples = free_samples;
  ops.equal = equal_types;
  ops.hash = hash_type;
  return ops;
}

const ddsi_sertype_ops kTypeOperations = make_type_operations();

}  // namespace

ddsi_sertype* make_byte_type(const std::string& dds_name) {
  auto type = std::make_unique<ByteType>();
  ddsi_sertype_init_flags(&type->c, dds_name.c_str(), &kTypeOperations, &kMessageOperations,
                          DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  type->c.allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return &type.release()->c;
}

ddsi_serdata* make_byte_message(const ddsi_sertype* type, std::span<const std::byte> bytes) {
  ByteMessage* message = new_message(type, SDK_DATA, bytes.size());
  if (message != nullptr && !bytes.empty()) {
    std::memcpy(message->bytes.data(), bytes.data(), bytes.size());
  }
  return released(message);
}

void copy_bytes(const ddsi_serdata* message, std::vector<std::byte>& bytes) {
  const ByteMessage& from = as_bytes(message);
  bytes.assign(from.bytes.begin(), from.bytes.begin() + static_cast<std::ptrdiff_t>(from.size));
}

}  // namespace depthgrid::dds
