// The fields of every message, in the order in which they are written: read and written by the same list. Internal.
#pragma once

#include <concepts>
#include <type_traits>

#include "depthgrid/messages/serialization.hpp"

namespace depthgrid::messages {

/// A message to be written, or one to be read into.
template <class Message, class Type>
concept Is = std::same_as<std::remove_const_t<Message>, Type>;

// fields(a, message) calls a("name of the field", field) for each.

template <class A, class M>
requires Is<M, Time> || Is<M, Duration>
void fields(A& a, M& m) {
  a("sec", m.sec);
  a("nanosec", m.nanosec);
}

template <class A, Is<Header> M>
void fields(A& a, M& m) {
  a("stamp", m.stamp);
  a("frame_id", m.frame_id);
}

template <class A, Is<Text> M>
void fields(A& a, M& m) {
  a("data", m.data);
}

template <class A, Is<Color> M>
void fields(A& a, M& m) {
  a("r", m.r);
  a("g", m.g);
  a("b", m.b);
  a("a", m.a);
}

template <class A, class M>
requires Is<M, Point> || Is<M, Vector3>
void fields(A& a, M& m) {
  a("x", m.x);
  a("y", m.y);
  a("z", m.z);
}

template <class A, Is<Quaternion> M>
void fields(A& a, M& m) {
  a("x", m.x);
  a("y", m.y);
  a("z", m.z);
  a("w", m.w);
}

template <class A, Is<PoseMessage> M>
void fields(A& a, M& m) {
  a("position", m.position);
  a("orientation", m.orientation);
}

template <class A, Is<Transform> M>
void fields(A& a, M& m) {
  a("translation", m.translation);
  a("rotation", m.rotation);
}

template <class A, Is<TransformStamped> M>
void fields(A& a, M& m) {
  a("header", m.header);
  a("child_frame_id", m.child_frame_id);
  a("transform", m.transform);
}

template <class A, Is<Transforms> M>
void fields(A& a, M& m) {
  a("transforms", m.transforms);
}

template <class A, Is<Image> M>
void fields(A& a, M& m) {
  a("header", m.header);
  a("height", m.height);
  a("width", m.width);
  a("encoding", m.encoding);
  a("is_bigendian", m.is_bigendian);
  a("step", m.step);
  a("data", m.data);
}

template <class A, Is<CompressedImage> M>
void fields(A& a, M& m) {
  a("header", m.header);
  a("format", m.format);
  a("data", m.data);
}

template <class A, Is<RegionOfInterest> M>
void fields(A& a, M& m) {
  a("x_offset", m.x_offset);
  a("y_offset", m.y_offset);
  a("height", m.height);
  a("width", m.width);
  a("do_rectify", m.do_rectify);
}

template <class A, Is<CameraInfo> M>
void fields(A& a, M& m) {
  a("header", m.header);
  a("height", m.height);
  a("width", m.width);
  a("distortion_model", m.distortion_model);
  a("d", m.d);
  a("k", m.k);
  a("r", m.r);
  a("p", m.p);
  a("binning_x", m.binning_x);
  a("binning_y", m.binning_y);
  a("roi", m.roi);
}

template <class A, Is<JointState> M>
void fields(A& a, M& m) {
  a("header", m.header);
  a("name", m.name);
  a("position", m.position);
  a("velocity", m.velocity);
  a("effort", m.effort);
}

template <class A, Is<TexturePoint> M>
void fields(A& a, M& m) {
  a("u", m.u);
  a("v", m.v);
}

template <class A, Is<MeshFile> M>
void fields(A& a, M& m) {
  a("filename", m.filename);
  a("data", m.data);
}

template <class A, Is<Marker> M>
void fields(A& a, M& m) {
  a("header", m.header);
  a("ns", m.ns);
  a("id", m.id);
  a("type", m.type);
  a("action", m.action);
  a("pose", m.pose);
  a("scale", m.scale);
  a("color", m.color);
  a("lifetime", m.lifetime);
  a("frame_locked", m.frame_locked);
  a("points", m.points);
  a("colors", m.colors);
  a("texture_resource", m.texture_resource);
  a("texture", m.texture);
  a("uv_coordinates", m.uv_coordinates);
  a("text", m.text);
  a("mesh_resource", m.mesh_resource);
  a("mesh_file", m.mesh_file);
  a("mesh_use_embedded_materials", m.mesh_use_embedded_materials);
}

template <class A, Is<Markers> M>
void fields(A& a, M& m) {
  a("markers", m.markers);
}

template <class A, Is<KeyValue> M>
void fields(A& a, M& m) {
  a("key", m.key);
  a("value", m.value);
}

template <class A, Is<DiagnosticStatus> M>
void fields(A& a, M& m) {
  a("level", m.level);
  a("name", m.name);
  a("message", m.message);
  a("hardware_id", m.hardware_id);
  a("values", m.values);
}

template <class A, Is<Diagnostics> M>
void fields(A& a, M& m) {
  a("header", m.header);
  a("status", m.status);
}

template <class A, Is<Distance> M>
void fields(A& a, M& m) {
  a("id", m.id);
  a("distance", m.distance);
  a("distance_now", m.distance_now);
  a("state", m.state);
  a("reason", m.reason);
  a("nearest", m.nearest);
  a("direction", m.direction);
  a("on_axis", m.on_axis);
  a("camera", m.camera);
  a("known_to", m.known_to);
  a("blind", m.blind);
  a("stale", m.stale);
  a("budget", m.budget);
}

template <class A, Is<Distances> M>
void fields(A& a, M& m) {
  a("header", m.header);
  a("distances", m.distances);
  a("cameras", m.cameras);
  a("image_ages", m.image_ages);
  a("image_stamps", m.image_stamps);
  a("image_joint_stamps", m.image_joint_stamps);
  a("joint_stamp", m.joint_stamp);
  a("sequence", m.sequence);
  a("stop", m.stop);
}

}  // namespace depthgrid::messages
