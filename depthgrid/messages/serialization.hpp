// Messages to bytes and back: CDR, as ROS 2 sends and records them.
//
// For Image, CompressedImage, CameraInfo, JointState, Transforms, Text, Markers, Diagnostics, Distances.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "depthgrid/messages/camera_info.hpp"
#include "depthgrid/messages/compressed_image.hpp"
#include "depthgrid/messages/diagnostics.hpp"
#include "depthgrid/messages/distances.hpp"
#include "depthgrid/messages/image.hpp"
#include "depthgrid/messages/joint_state.hpp"
#include "depthgrid/messages/markers.hpp"
#include "depthgrid/messages/message_type.hpp"
#include "depthgrid/messages/standard.hpp"
#include "depthgrid/messages/transforms.hpp"

namespace depthgrid::messages {

/// The type of a message that stands on its own.
template <class Message>
[[nodiscard]] const MessageType& type_of() noexcept;

/// Reads a message: XCDR1, of either byte order, with the four bytes in front that say which. Images are views of
/// `bytes`, everything else is copied. Whatever the bytes are, nothing outside of them is read, and no more memory
/// is taken than a small multiple of them. Bytes after the message are passed over. Throws Error that names the type,
/// the field, and what it needs.
template <class Message>
[[nodiscard]] Message from_bytes(std::span<const std::byte> bytes);

/// Writes it, little endian, in place of what `bytes` held; the memory is used again. Throws Error for texts and lists
/// of 4 GiB and more.
template <class Message>
void to_bytes(const Message& message, std::vector<std::byte>& bytes);

/// The same in memory of its own.
template <class Message>
[[nodiscard]] std::vector<std::byte> to_bytes(const Message& message) {
  std::vector<std::byte> bytes;
  to_bytes(message, bytes);
  return bytes;
}

// Of each message. Specialisations, since the library keeps templates to itself.

template <>
const MessageType& type_of<Image>() noexcept;
template <>
Image from_bytes<Image>(std::span<const std::byte> bytes);
template <>
void to_bytes(const Image& message, std::vector<std::byte>& bytes);
template <>
const MessageType& type_of<CompressedImage>() noexcept;
template <>
CompressedImage from_bytes<CompressedImage>(std::span<const std::byte> bytes);
template <>
void to_bytes(const CompressedImage& message, std::vector<std::byte>& bytes);
template <>
const MessageType& type_of<CameraInfo>() noexcept;
template <>
CameraInfo from_bytes<CameraInfo>(std::span<const std::byte> bytes);
template <>
void to_bytes(const CameraInfo& message, std::vector<std::byte>& bytes);
template <>
const MessageType& type_of<JointState>() noexcept;
template <>
JointState from_bytes<JointState>(std::span<const std::byte> bytes);
template <>
void to_bytes(const JointState& message, std::vector<std::byte>& bytes);
template <>
const MessageType& type_of<Transforms>() noexcept;
template <>
Transforms from_bytes<Transforms>(std::span<const std::byte> bytes);
template <>
void to_bytes(const Transforms& message, std::vector<std::byte>& bytes);
template <>
const MessageType& type_of<Text>() noexcept;
template <>
Text from_bytes<Text>(std::span<const std::byte> bytes);
template <>
void to_bytes(const Text& message, std::vector<std::byte>& bytes);
template <>
const MessageType& type_of<Markers>() noexcept;
template <>
Markers from_bytes<Markers>(std::span<const std::byte> bytes);
template <>
void to_bytes(const Markers& message, std::vector<std::byte>& bytes);
template <>
const MessageType& type_of<Diagnostics>() noexcept;
template <>
Diagnostics from_bytes<Diagnostics>(std::span<const std::byte> bytes);
template <>
void to_bytes(const Diagnostics& message, std::vector<std::byte>& bytes);
template <>
const MessageType& type_of<Distances>() noexcept;
template <>
Distances from_bytes<Distances>(std::span<const std::byte> bytes);
template <>
void to_bytes(const Distances& message, std::vector<std::byte>& bytes);

}  // namespace depthgrid::messages
