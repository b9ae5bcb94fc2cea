#include "program/distances/answer_writer.hpp"

#include <rapidjson/stringbuffer.h>
#include <rapidjson/writer.h>

#include <utility>

#include "report/number_text.hpp"

namespace depthgrid::program {

namespace {

using Json = rapidjson::Writer<rapidjson::StringBuffer>;

void write_number(Json& json, const std::string& text) {
  if (text.empty()) {
    json.Null();
  } else {
    json.RawValue(text.data(), text.size(), rapidjson::kNumberType);
  }
}

void write_string(Json& json, std::string_view text) {
  json.String(text.data(), static_cast<rapidjson::SizeType>(text.size()));
}

/// A CSV cell; quoted only where it has to be.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c;
    if (c == '"') {
      quoted += c;
    }
  }
  return quoted + '"';
}

struct Texts {
  std::string x, y, z;

  static Texts of(const Eigen::Vector3d& v, std::string (*text)(double)) {
    return {text(v.x()), text(v.y()), text(v.z())};
  }
  [[nodiscard]] std::string csv() const { return x + ',' + y + ',' + z; }
  void json(Json& writer) const {
    if (x.empty()) {
      writer.Null();
      return;
    }
    writer.StartArray();
    write_number(writer, x);
    write_number(writer, y);
    write_number(writer, z);
    writer.EndArray();
  }
};

}  // namespace

struct AnswerWriter::Row {
  int frame = 0;
  std::string time_s;
  std::string point;
  Texts position;
  std::string distance_m;
  std::string_view state;
  std::string camera;
  Texts nearest;
  Texts direction;
  bool stale = false;
  bool budget = false;
  std::string known_to_m;
  std::string blind_m;
  Texts hybrid_direction;
  std::int64_t obstacle_points = 0;
  std::string radius_m;
  Texts end;
  Texts on_axis;
  std::string reason;
  std::string hidden_s;
  Texts from;
};

AnswerWriter::AnswerWriter(AnswerFormat format, const Rig& rig, Pose T_output_world, const AnswerColumns& columns)
    : format_(format), rig_(rig), T_output_world_(std::move(T_output_world)), columns_(columns) {}

std::string AnswerWriter::header() const {
  if (format_ == AnswerFormat::json_lines) {
    return {};
  }
  return std::string(
             "frame,time_s,point,x_m,y_m,z_m,distance_m,state,camera,nearest_x_m,nearest_y_m,nearest_z_m,"
             "direction_x,direction_y,direction_z,stale,budget,known_to_m,blind_m") +
         (columns_.hybrid_direction ? ",hybrid_x,hybrid_y,hybrid_z" : "") +
         (columns_.obstacle_points ? ",obstacle_points" : "") +
         (columns_.shapes ? ",radius_m,end_x_m,end_y_m,end_z_m,on_axis_x_m,on_axis_y_m,on_axis_z_m" : "") +
         (columns_.reasons ? ",reason,hidden_s,from_x_m,from_y_m,from_z_m\n" : "\n");
}

std::string AnswerWriter::line(int frame, std::optional<double> time_s, const files::ControlPoint& point,
                               const Answer& answer, const AnswerReason& reason) const {
  const Proximity& nearest = answer.nearest;
  Row row;
  row.frame = frame;
  row.time_s = time_s ? report::micro_text(*time_s) : std::string();
  row.point = point.id;
  row.position = Texts::of(point.capsule.a, report::exact_text);
  row.distance_m = has_distance(nearest) ? report::micro_text_down(nearest.distance_m) : std::string();
  row.state = to_string(nearest.state);
  row.camera = nearest.camera ? rig_.cameras[*nearest.camera].id : std::string();
  row.nearest = Texts::of(T_output_world_ * nearest.nearest_world, report::micro_text);
  row.direction = Texts::of(T_output_world_.linear() * nearest.direction_world, report::micro_text);
  row.stale = nearest.stale;
  row.budget = nearest.budget;
  row.known_to_m = report::micro_text_down(nearest.known_to_m);
  row.blind_m = report::micro_text_up(answer.blind_m);
  row.hybrid_direction = Texts::of(T_output_world_.linear() * answer.hybrid_direction_world, report::micro_text);
  row.obstacle_points = answer.obstacle_points;
  row.radius_m = report::exact_text(point.capsule.radius_m);
  row.end = point.has_end ? Texts::of(point.capsule.b, report::exact_text) : Texts{};
  row.on_axis = Texts::of(T_output_world_ * answer.on_axis_world, report::micro_text);
  row.reason = reason.text;
  row.hidden_s = reason.hidden_s ? report::micro_text(*reason.hidden_s) : std::string();
  row.from = Texts::of(T_output_world_ * reason.from_world, report::micro_text);
  return format_ == AnswerFormat::csv ? csv(row) : json(row);
}

std::string AnswerWriter::csv(const Row& row) const {
  const auto yes = [](bool value) { return value ? "true" : "false"; };
  std::string text = std::to_string(row.frame) + ',' + row.time_s + ',' + cell(row.point) + ',' + row.position.csv() +
                     ',' + row.distance_m + ',' + std::string(row.state) + ',' + cell(row.camera) + ',' +
                     row.nearest.csv() + ',' + row.direction.csv() + ',' + yes(row.stale) + ',' + yes(row.budget) +
                     ',' + row.known_to_m + ',' + row.blind_m;
  if (columns_.hybrid_direction) {
    text += ',' + row.hybrid_direction.csv();
  }
  if (columns_.obstacle_points) {
    text += ',' + std::to_string(row.obstacle_points);
  }
  if (columns_.shapes) {
    text += ',' + row.radius_m + ',' + row.end.csv() + ',' + row.on_axis.csv();
  }
  if (columns_.reasons) {
    text += ',' + cell(row.reason) + ',' + row.hidden_s + ',' + row.from.csv();
  }
  return text + '\n';
}

std::string AnswerWriter::json(const Row& row) const {
  rapidjson::StringBuffer buffer;
  Json writer(buffer);
  writer.StartObject();
  writer.Key("frame");
  writer.Int(row.frame);
  writer.Key("time_s");
  write_number(writer, row.time_s);
  writer.Key("point");
  write_string(writer, row.point);
  writer.Key("position_m");
  row.position.json(writer);
  writer.Key("distance_m");
  write_number(writer, row.distance_m);
  writer.Key("state");
  write_string(writer, row.state);
  writer.Key("camera");
  if (row.camera.empty()) {
    writer.Null();
  } else {
    write_string(writer, row.camera);
  }
  writer.Key("nearest_m");
  row.nearest.json(writer);
  writer.Key("direction");
  row.direction.json(writer);
  writer.Key("stale");
  writer.Bool(row.stale);
  writer.Key("budget");
  writer.Bool(row.budget);
  writer.Key("known_to_m");
  write_number(writer, row.known_to_m);
  writer.Key("blind_m");
  write_number(writer, row.blind_m);
  if (columns_.hybrid_direction) {
    writer.Key("hybrid_direction");
    row.hybrid_direction.json(writer);
  }
  if (columns_.obstacle_points) {
    writer.Key("obstacle_points");
    writer.Int64(row.obstacle_points);
  }
  if (columns_.shapes) {
    writer.Key("radius_m");
    write_number(writer, row.radius_m);
    writer.Key("end_m");
    row.end.json(writer);
    writer.Key("on_axis_m");
    row.on_axis.json(writer);
  }
  if (columns_.reasons) {
    writer.Key("reason");
    write_string(writer, row.reason);
    writer.Key("hidden_s");
    write_number(writer, row.hidden_s);
    writer.Key("from_m");
    row.from.json(writer);
  }
  writer.EndObject();
  return std::string(buffer.GetString(), buffer.GetSize()) + '\n';
}

}  // namespace depthgrid::program
