#include "depthgrid/messages/serialization.hpp"

#include <string>

#include "depthgrid/messages/cdr_reader.hpp"
#include "depthgrid/messages/cdr_writer.hpp"
#include "depthgrid/messages/fields.hpp"

namespace depthgrid::messages {
namespace {

class FieldReader {
 public:
  explicit FieldReader(CdrReader& from) noexcept : from_(from) {}

  template <CdrNumber Number>
  void operator()(const char* name, Number& value) {
    value = from_.number<Number>(name);
  }
  void operator()(const char* name, bool& value) { value = from_.flag(name); }
  void operator()(const char* name, std::string& value) { value = from_.text(name); }
  void operator()(const char* name, std::span<const std::byte>& value) { value = from_.bytes(name); }
  template <CdrNumber Number, std::size_t N>
  void operator()(const char* name, std::array<Number, N>& values) {
    from_.numbers(std::span<Number>(values), name);
  }
  template <CdrNumber Number>
  void operator()(const char* name, std::vector<Number>& values) {
    const std::uint32_t count = from_.count(name);
    from_.require_numbers(count, sizeof(Number), name);
    values.resize(count);
    from_.numbers(std::span<Number>(values), name);
  }
  /// One after the other: memory is taken for those that are there, whatever their number is said to be.
  template <class Element>
  void operator()(const char* name, std::vector<Element>& values) {
    values.clear();
    for (std::uint32_t left = from_.count(name); left > 0; --left) {
      (*this)(name, values.emplace_back());
    }
  }
  template <class Message>
  void operator()(const char* /*name*/, Message& message) {
    fields(*this, message);
  }

 private:
  CdrReader& from_;
};

class FieldWriter {
 public:
  explicit FieldWriter(CdrWriter& to) noexcept : to_(to) {}

  template <CdrNumber Number>
  void operator()(const char* /*name*/, const Number& value) {
    to_.number(value);
  }
  void operator()(const char* /*name*/, const bool& value) { to_.flag(value); }
  void operator()(const char* /*name*/, const std::string& value) { to_.text(value); }
  void operator()(const char* /*name*/, const std::span<const std::byte>& value) { to_.bytes(value); }
  template <CdrNumber Number, std::size_t N>
  void operator()(const char* name, const std::array<Number, N>& values) {
    for (const Number& value : values) {
      (*this)(name, value);
    }
  }
  template <class Element>
  void operator()(const char* name, const std::vector<Element>& values) {
    to_.count(values.size());
    for (const Element& value : values) {
      (*this)(name, value);
    }
  }
  template <class Message>
  void operator()(const char* /*name*/, const Message& message) {
    fields(*this, message);
  }

 private:
  CdrWriter& to_;
};

template <class Message>
Message read_message(std::span<const std::byte> bytes) {
  CdrReader reader(bytes, type_of<Message>().name);
  FieldReader read(reader);
  Message message;
  fields(read, message);
  return message;
}

template <class Message>
void write_message(const Message& message, std::vector<std::byte>& bytes) {
  CdrWriter writer(bytes);
  FieldWriter write(writer);
  fields(write, message);
}

}  // namespace

// NOLINTBEGIN(cppcoreguidelines-macro-usage, bugprone-macro-parentheses): a type cannot stand in parentheses
#define DEPTHGRID_MESSAGE(Message, type_name)                            \
  template <>                                                            \
  const MessageType& type_of<Message>() noexcept {                       \
    static const MessageType& type = message_type(type_name);            \
    return type;                                                         \
  }                                                                      \
  template <>                                                            \
  Message from_bytes<Message>(std::span<const std::byte> bytes) {        \
    return read_message<Message>(bytes);                                 \
  }                                                                      \
  template <>                                                            \
  void to_bytes(const Message& message, std::vector<std::byte>& bytes) { \
    write_message(message, bytes);                                       \
  }
// NOLINTEND(cppcoreguidelines-macro-usage, bugprone-macro-parentheses)

DEPTHGRID_MESSAGE(Image, "sensor_msgs/msg/Image")
DEPTHGRID_MESSAGE(CompressedImage, "sensor_msgs/msg/CompressedImage")
DEPTHGRID_MESSAGE(CameraInfo, "sensor_msgs/msg/CameraInfo")
DEPTHGRID_MESSAGE(JointState, "sensor_msgs/msg/JointState")
DEPTHGRID_MESSAGE(Transforms, "tf2_msgs/msg/TFMessage")
DEPTHGRID_MESSAGE(Text, "std_msgs/msg/String")
DEPTHGRID_MESSAGE(Markers, "visualization_msgs/msg/MarkerArray")
DEPTHGRID_MESSAGE(Diagnostics, "diagnostic_msgs/msg/DiagnosticArray")
DEPTHGRID_MESSAGE(Distances, "depthgrid_msgs/msg/Distances")
#undef DEPTHGRID_MESSAGE

}  // namespace depthgrid::messages
