#include "robot/program_digest.hpp"
#include "robot/text_form.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace incise {
namespace {

static_assert(std::endian::native == std::endian::little,
              "bags are little endian, and so are the numbers written here");

constexpr std::size_t kBagHeaderRecord = 4096;
constexpr std::uint64_t kStamp = 1;  // s in the low, ns in the high 32 bits; time 0 means "now" to ROS
constexpr std::uint8_t kOpMessage = 0x02, kOpBagHeader = 0x03, kOpIndex = 0x04, kOpChunk = 0x05, kOpChunkInfo = 0x06,
                       kOpConnection = 0x07;

/// Bytes in the layout of ROS: little endian; strings and lists follow their 32-bit length.
class Bytes {
 public:
  template <class Number>
  Bytes& number(Number value) {
    data_.append(reinterpret_cast<const char*>(&value), sizeof(value));
    return *this;
  }
  Bytes& text(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size()));
    data_ += value;
    return *this;
  }
  /// One field of a record's header: NAME=value after its length.
  Bytes& field(const std::string& name, const std::string& value) { return text(name + "=" + value); }
  template <class Number>
  Bytes& field_number(const std::string& name, Number value) {
    return field(name, Bytes().number(value).data_);
  }
  Bytes& joints(const Joints& values) {
    number(std::uint32_t{6});
    for (int i = 0; i < 6; ++i) number(values[i]);
    return *this;
  }
  [[nodiscard]] const std::string& data() const { return data_; }

 private:
  std::string data_;
};

std::string record(const Bytes& header, const std::string& data) {
  return Bytes().text(header.data()).text(data).data();
}

struct Connection {
  std::uint32_t id;
  std::string topic, type, md5, definition;
  std::string message;
};

std::string connection_record(const Connection& c) {
  const Bytes header = Bytes().field_number("op", kOpConnection).field_number("conn", c.id).field("topic", c.topic);
  const Bytes data = Bytes()
                         .field("topic", c.topic)
                         .field("type", c.type)
                         .field("md5sum", c.md5)
                         .field("message_definition", c.definition);
  return record(header, data.data());
}

std::string trajectory_definition() {
  const std::string line = std::string(80, '=') + "\n";
  return "Header header\nstring[] joint_names\nJointTrajectoryPoint[] points\n" + line +
         "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n" + line +
         "MSG: trajectory_msgs/JointTrajectoryPoint\nfloat64[] positions\nfloat64[] velocities\nfloat64[] "
         "accelerations\nfloat64[] effort\nduration time_from_start\n";
}

std::string trajectory_message(const RobotProgram& program) {
  Bytes bytes;
  bytes.number(std::uint32_t{0}).number(std::uint32_t{0}).number(std::uint32_t{0}).text("base");
  bytes.number(std::uint32_t{6});
  for (const std::string& name : program.setup.arm.joint_names) bytes.text(name);
  bytes.number(static_cast<std::uint32_t>(program.motion.samples.size()));
  for (const JointSample& s : program.motion.samples) {
    bytes.joints(s.q_rad).joints(s.speed_rad_s).joints(s.acceleration_rad_s2).number(std::uint32_t{0});
    const auto ns = static_cast<std::int64_t>(std::llround(s.time_s * 1e9));
    bytes.number(static_cast<std::int32_t>(ns / 1000000000)).number(static_cast<std::int32_t>(ns % 1000000000));
  }
  return bytes.data();
}

}  // namespace

std::string to_rosbag(const RobotProgram& program, const ProgramHeader& header) {
  robot_detail::require_motion(program);
  // The MD5 sums are those that ROS computes from the definitions; a subscriber refuses others.
  const Connection connections[] = {
      {0, "/incise/header", "std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1", "string data\n",
       Bytes().text(robot_detail::header_lines(header)).data()},
      {1, "/joint_trajectory", "trajectory_msgs/JointTrajectory", "65b4f94a94d1ed67169da35a02f33d3f",
       trajectory_definition(), trajectory_message(program)}};

  std::string chunk, indices, connection_records;
  Bytes counts;
  for (const Connection& c : connections) {
    chunk += connection_record(c);
    connection_records += connection_record(c);
    const auto offset = static_cast<std::uint32_t>(chunk.size());
    chunk += record(Bytes().field_number("op", kOpMessage).field_number("conn", c.id).field_number("time", kStamp),
                    c.message);
    indices += record(Bytes()
                          .field_number("op", kOpIndex)
                          .field_number("ver", std::uint32_t{1})
                          .field_number("conn", c.id)
                          .field_number("count", std::uint32_t{1}),
                      Bytes().number(kStamp).number(offset).data());
    counts.number(c.id).number(std::uint32_t{1});
  }

  const std::string magic = "#ROSBAG V2.0\n";
  const std::uint64_t chunk_pos = magic.size() + kBagHeaderRecord;
  const std::string chunk_record = record(Bytes()
                                              .field_number("op", kOpChunk)
                                              .field("compression", "none")
                                              .field_number("size", static_cast<std::uint32_t>(chunk.size())),
                                          chunk);
  const std::uint64_t index_pos = chunk_pos + chunk_record.size() + indices.size();
  const Bytes bag_header = Bytes()
                               .field_number("op", kOpBagHeader)
                               .field_number("index_pos", index_pos)
                               .field_number("conn_count", std::uint32_t{2})
                               .field_number("chunk_count", std::uint32_t{1});
  // The first record is padded, so that a writer can change it later.
  const std::size_t padding = kBagHeaderRecord - 2 * sizeof(std::uint32_t) - bag_header.data().size();
  const std::string chunk_info = record(Bytes()
                                            .field_number("op", kOpChunkInfo)
                                            .field_number("ver", std::uint32_t{1})
                                            .field_number("chunk_pos", chunk_pos)
                                            .field_number("start_time", kStamp)
                                            .field_number("end_time", kStamp)
                                            .field_number("count", std::uint32_t{2}),
                                        counts.data());
  return robot_detail::sealed(magic + record(bag_header, std::string(padding, ' ')) + chunk_record + indices +
                              connection_records + chunk_info);
}

}  // namespace incise
