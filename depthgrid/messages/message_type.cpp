#include "depthgrid/messages/message_type.hpp"

#include <array>
#include <initializer_list>

#include "depthgrid/core/error.hpp"

namespace depthgrid::messages {
namespace {

/// The fields of a type that others hold, as in its .msg file.
struct Part {
  std::string_view name;
  std::string_view fields;
};

constexpr Part kTime{"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"};
constexpr Part kDuration{"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"};
constexpr Part kHeader{"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"};
constexpr Part kColor{"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"};
constexpr Part kPoint{"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"};
constexpr Part kVector3{"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"};
constexpr Part kQuaternion{"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"};
constexpr Part kPose{"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"};
constexpr Part kTransform{"geometry_msgs/Transform",
                          "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"};
constexpr Part kTransformStamped{"geometry_msgs/TransformStamped",
                                 "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"};
constexpr Part kRegionOfInterest{"sensor_msgs/RegionOfInterest",
                                 "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n"};
constexpr Part kCompressedImage{"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"};
constexpr Part kTexturePoint{"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"};
constexpr Part kMeshFile{"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"};
constexpr Part kMarker{"visualization_msgs/Marker",
                       "int32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\n"
                       "int32 LINE_LIST=5\nint32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\n"
                       "int32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\nint32 TRIANGLE_LIST=11\n"
                       "int32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\n"
                       "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\n"
                       "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\n"
                       "builtin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\n"
                       "std_msgs/ColorRGBA[] colors\nstring texture_resource\nsensor_msgs/CompressedImage texture\n"
                       "visualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\n"
                       "visualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n"};
constexpr Part kKeyValue{"diagnostic_msgs/KeyValue", "string key\nstring value\n"};
constexpr Part kDiagnosticStatus{"diagnostic_msgs/DiagnosticStatus",
                                 "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\n"
                                 "byte level\nstring name\nstring message\nstring hardware_id\n"
                                 "diagnostic_msgs/KeyValue[] values\n"};
constexpr Part kDistance{
    "depthgrid_msgs/Distance",
    "# From a point, sphere or capsule to the nearest place that no camera has seen free. Metres; NaN: not known.\n"
    "uint8 NOT_EVALUATED=0\nuint8 MEASURED=1\nuint8 OCCLUDED=2\nuint8 UNMEASURED=3\nuint8 UNOBSERVED=4\n"
    "uint8 OUTSIDE=5\nuint8 BEYOND_RHO=6\n"
    "string id\n"
    "float64 distance      # a lower bound, at the time of the images\n"
    "float64 distance_now  # the same at the header's stamp\n"
    "uint8 state           # what stands at the nearest point\n"
    "string reason         # in words\n"
    "geometry_msgs/Point nearest\n"
    "geometry_msgs/Vector3 direction  # unit vector to the obstacle\n"
    "geometry_msgs/Point on_axis\n"
    "string camera         # that measured it; empty: none did\n"
    "float64 known_to      # obstacles farther than this may be missing\n"
    "float64 blind         # what is nearer to the robot may be missing\n"
    "bool stale\n"
    "bool budget\n"};

/// "ros2msg" as MCAP wants it.
std::string definition(std::string_view fields, std::initializer_list<Part> parts) {
  constexpr std::size_t kRule = 80;
  std::string text(fields);
  for (const Part& part : parts) {
    text += std::string(kRule, '=') + "\nMSG: " + std::string(part.name) + "\n" + std::string(part.fields);
  }
  return text;
}

using Texts = std::array<std::string, 9>;

const Texts& definitions() {
  static const Texts texts{
      definition("std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\n"
                 "uint32 step\nuint8[] data\n",
                 {kHeader, kTime}),
      definition(kCompressedImage.fields, {kHeader, kTime}),
      definition("std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\n"
                 "float64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 binning_y\n"
                 "sensor_msgs/RegionOfInterest roi\n",
                 {kHeader, kTime, kRegionOfInterest}),
      definition("std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n",
                 {kHeader, kTime}),
      definition("geometry_msgs/TransformStamped[] transforms\n",
                 {kTransformStamped, kHeader, kTime, kTransform, kVector3, kQuaternion}),
      definition("string data\n", {}),
      definition("visualization_msgs/Marker[] markers\n",
                 {kMarker, kHeader, kTime, kPose, kPoint, kQuaternion, kVector3, kColor, kDuration, kCompressedImage,
                  kTexturePoint, kMeshFile}),
      definition("std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n",
                 {kHeader, kTime, kDiagnosticStatus, kKeyValue}),
      definition("# Distances from parts of a robot to the nearest places that no camera has seen free.\n"
                 "std_msgs/Header header  # the time that distance_now is of, and the frame of all coordinates\n"
                 "depthgrid_msgs/Distance[] distances\n"
                 "string[] cameras\n"
                 "float64[] image_ages  # one a camera: seconds from its newest image to the stamp; NaN: none\n"
                 "# What the answer stands on; a time of 0: none, or not told.\n"
                 "builtin_interfaces/Time[] image_stamps        # one a camera: of its image\n"
                 "builtin_interfaces/Time[] image_joint_stamps  # one a camera: the newest joint state known when the "
                 "robot was taken out\n"
                 "builtin_interfaces/Time joint_stamp           # the newest joint state known\n"
                 "uint64 sequence\n"
                 "bool stop\n",
                 {kHeader, kTime, kDistance, kPoint, kVector3})};
  return texts;
}

constexpr std::array<std::array<std::string_view, 3>, 9> kNames{{
    {"sensor_msgs/msg/Image", "sensor_msgs::msg::dds_::Image_",
     "RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47"},
    {"sensor_msgs/msg/CompressedImage", "sensor_msgs::msg::dds_::CompressedImage_",
     "RIHS01_15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a"},
    {"sensor_msgs/msg/CameraInfo", "sensor_msgs::msg::dds_::CameraInfo_",
     "RIHS01_b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275"},
    {"sensor_msgs/msg/JointState", "sensor_msgs::msg::dds_::JointState_",
     "RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"},
    {"tf2_msgs/msg/TFMessage", "tf2_msgs::msg::dds_::TFMessage_",
     "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"},
    {"std_msgs/msg/String", "std_msgs::msg::dds_::String_",
     "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"},
    {"visualization_msgs/msg/MarkerArray", "visualization_msgs::msg::dds_::MarkerArray_",
     "RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf"},
    {"diagnostic_msgs/msg/DiagnosticArray", "diagnostic_msgs::msg::dds_::DiagnosticArray_",
     "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"},
    {"depthgrid_msgs/msg/Distances", "depthgrid_msgs::msg::dds_::Distances_",
     "RIHS01_3ca0acef299bcb15792d9e1461d85a2d0771fc64d6d088c3ef9da2e386128112"},
}};

using Types = std::array<MessageType, kNames.size()>;

Types make_types() {
  Types types;
  for (std::size_t i = 0; i < types.size(); ++i) {
    const auto& [name, dds_name, hash] = kNames[i];
    types[i] = {.name = name, .dds_name = dds_name, .hash = hash, .definition = definitions()[i]};
  }
  return types;
}

}  // namespace

std::span<const MessageType> message_types() noexcept {
  static const Types types = make_types();
  return types;
}

const MessageType& message_type(std::string_view name) {
  std::string known;
  for (const MessageType& type : message_types()) {
    if (type.name == name) {
      return type;
    }
    known += (known.empty() ? "" : ", ") + std::string(type.name);
  }
  fail("there is no message type '", name, "' here, known are ", known);
}

}  // namespace depthgrid::messages
