/* The datagram that `depthgrid run` sends with every answer, for controllers that read nothing else. C99 and C++; this
 * file alone is needed.
 *
 *   struct depthgrid_answer answer;
 *   if (depthgrid_read_datagram(bytes, size, &answer) == DEPTHGRID_DATAGRAM_OK && answer.stop == 0) { ... }
 *
 * - Layout: 836 bytes, little-endian, no padding; numbers IEEE 754. What is not known is NaN, never a special number.
 * - Frame and units: world, metres, seconds.
 * - The controller's duty: stop when the newest datagram is too old by its own clock, when a sequence number does not
 *   grow, and at every comparison that NaN makes false: !(distance > limit).
 * - Nothing here allocates, locks or fails in other ways than the result says.
 *
 *   offset  bytes
 *        0      4  "DGRD"
 *        4      2  version, 1
 *        6      2  size of the datagram, 836
 *        8      8  sequence number, from 1, one more with every answer; gaps are answers that were passed over
 *       16      8  double: the time that the answer is for, on the sender's clock (CLOCK_MONOTONIC)
 *       24      8  double: the newest exposure behind it
 *       32      1  state, enum depthgrid_state
 *       33      1  stop: 1, unless every part is clear (below) of the cell's stop_m
 *       34      1  cameras, at most 16
 *       35      1  parts, at most 32
 *       36      4  a bit a camera: its image is too old, or there is none
 *       40      4  float: the least distance of all parts; NaN when one has none
 *       44      4  float: the least of distance less blind layer, not below 0; NaN likewise
 *       48      4  float: how thick the layer around the robot is in which nothing is seen
 *       52      4  float: between the oldest and the newest image
 *       56      4  float: age of the newest joint state; 0 without a robot
 *       60      4  float: from the newest exposure until the answer was there
 *       64     64  float a camera: age of its image
 *      128     64  float a camera: share of its pixels without a reading
 *      192    640  20 bytes a part: float distance, 3 floats nearest point, byte enum depthgrid_part_state, 3 bytes 0
 *      832      4  CRC-32 (IEEE 802.3, as zlib's) of the 832 bytes before
 */
#ifndef DEPTHGRID_NETWORK_DATAGRAM_H
#define DEPTHGRID_NETWORK_DATAGRAM_H

/* NOLINTBEGIN(modernize-deprecated-headers,modernize-use-using,modernize-avoid-c-arrays): this is C */
/* NOLINTBEGIN(modernize-use-nullptr,cppcoreguidelines-macro-usage,cppcoreguidelines-avoid-c-arrays,cppcoreguidelines-pro-type-cstyle-cast): this is C */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define DEPTHGRID_DATAGRAM_SIZE 836
#define DEPTHGRID_DATAGRAM_VERSION 1
#define DEPTHGRID_MAX_CAMERAS 16
#define DEPTHGRID_MAX_PARTS 32

enum depthgrid_state {
  DEPTHGRID_NOTHING_NEAR = 0,     /* nothing within rho of any part */
  DEPTHGRID_OBSTACLE = 1,         /* distances are known */
  DEPTHGRID_BUDGET = 2,           /* the evaluation ended early: bounds, not yet distances */
  DEPTHGRID_BLIND_LAYER = 3,      /* something is nearer to a part than its blind layer is thick */
  DEPTHGRID_UNKNOWN_DISTANCE = 4, /* a part has no distance */
  DEPTHGRID_NO_IMAGES = 5,        /* no camera has an image that is new enough */
  DEPTHGRID_NO_JOINT_STATE = 6,   /* nobody knows where the robot is */
  DEPTHGRID_CLOCK = 7             /* the clock went back or stood still */
};

/* What stands at a part's nearest point. */
enum depthgrid_part_state {
  DEPTHGRID_NOT_EVALUATED = 0,
  DEPTHGRID_MEASURED = 1,   /* a surface */
  DEPTHGRID_OCCLUDED = 2,   /* space behind one */
  DEPTHGRID_UNMEASURED = 3, /* space without a reading */
  DEPTHGRID_UNOBSERVED = 4, /* space that no camera looks at */
  DEPTHGRID_OUTSIDE = 5,    /* the border of the space of interest */
  DEPTHGRID_BEYOND_RHO = 6  /* nothing within rho */
};

struct depthgrid_part {
  float distance_m;
  float nearest_m[3];
  uint8_t state;
};

struct depthgrid_answer {
  uint64_t sequence;
  double time_s;
  double exposure_s;
  uint8_t state;
  uint8_t stop;
  uint8_t cameras;
  uint8_t parts;
  uint32_t late_cameras;
  float distance_m;
  float clear_m;
  float blind_m;
  float skew_s;
  float joints_age_s;
  float latency_s;
  float image_age_s[DEPTHGRID_MAX_CAMERAS];
  float without_reading[DEPTHGRID_MAX_CAMERAS];
  struct depthgrid_part part[DEPTHGRID_MAX_PARTS];
};

enum depthgrid_datagram_result {
  DEPTHGRID_DATAGRAM_OK = 0,
  DEPTHGRID_DATAGRAM_SIZE_WRONG = 1,    /* not as long as it has to be */
  DEPTHGRID_DATAGRAM_MAGIC_WRONG = 2,   /* not from depthgrid */
  DEPTHGRID_DATAGRAM_VERSION_WRONG = 3, /* of another version: rebuild the reader */
  DEPTHGRID_DATAGRAM_CHECKSUM_WRONG = 4,
  DEPTHGRID_DATAGRAM_CONTENT_WRONG = 5 /* more cameras or parts than there may be, or a state that is none */
};

/* CRC-32 of `size` bytes. */
static inline uint32_t depthgrid_crc32(const unsigned char* bytes, size_t size) {
  static const uint32_t kTable[16] = {0x00000000U, 0x1db71064U, 0x3b6e20c8U, 0x26d930acU, 0x76dc4190U, 0x6b6b51f4U,
                                      0x4db26158U, 0x5005713cU, 0xedb88320U, 0xf00f9344U, 0xd6d6a3e8U, 0xcb61b38cU,
                                      0x9b64c2b0U, 0x86d3d2d4U, 0xa00ae278U, 0xbdbdf21cU};
  uint32_t crc = 0xffffffffU;
  size_t i;
  for (i = 0; i < size; ++i) {
    const uint32_t byte = bytes[i];
    crc = (crc >> 4U) ^ kTable[(crc ^ byte) & 15U];
    crc = (crc >> 4U) ^ kTable[(crc ^ (byte >> 4U)) & 15U];
  }
  return crc ^ 0xffffffffU;
}

static inline uint32_t depthgrid_read_u32(const unsigned char* bytes) {
  const uint32_t b0 = bytes[0];
  const uint32_t b1 = bytes[1];
  const uint32_t b2 = bytes[2];
  const uint32_t b3 = bytes[3];
  return b0 | b1 << 8U | b2 << 16U | b3 << 24U;
}

static inline uint64_t depthgrid_read_u64(const unsigned char* bytes) {
  const uint64_t low = depthgrid_read_u32(bytes);
  const uint64_t high = depthgrid_read_u32(bytes + 4);
  return low | high << 32U;
}

static inline float depthgrid_read_float(const unsigned char* bytes) {
  const uint32_t bits = depthgrid_read_u32(bytes);
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

static inline double depthgrid_read_double(const unsigned char* bytes) {
  const uint64_t bits = depthgrid_read_u64(bytes);
  double value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

/* Reads a datagram of `size` bytes. `answer` is written only when the result is DEPTHGRID_DATAGRAM_OK. */
static inline enum depthgrid_datagram_result depthgrid_read_datagram(const unsigned char* bytes, size_t size,
                                                                     struct depthgrid_answer* answer) {
  size_t i;
  size_t axis;
  if (size < 8U || bytes[0] != 'D' || bytes[1] != 'G' || bytes[2] != 'R' || bytes[3] != 'D') {
    return size < 8U ? DEPTHGRID_DATAGRAM_SIZE_WRONG : DEPTHGRID_DATAGRAM_MAGIC_WRONG;
  }
  if (bytes[4] != DEPTHGRID_DATAGRAM_VERSION || bytes[5] != 0) {
    return DEPTHGRID_DATAGRAM_VERSION_WRONG;
  }
  if (size != DEPTHGRID_DATAGRAM_SIZE || (depthgrid_read_u32(bytes + 4) >> 16U) != DEPTHGRID_DATAGRAM_SIZE) {
    return DEPTHGRID_DATAGRAM_SIZE_WRONG;
  }
  if (depthgrid_read_u32(bytes + 832) != depthgrid_crc32(bytes, 832)) {
    return DEPTHGRID_DATAGRAM_CHECKSUM_WRONG;
  }
  if (bytes[32] > DEPTHGRID_CLOCK || bytes[33] > 1 || bytes[34] > DEPTHGRID_MAX_CAMERAS ||
      bytes[35] > DEPTHGRID_MAX_PARTS) {
    return DEPTHGRID_DATAGRAM_CONTENT_WRONG;
  }
  for (i = 0; i < DEPTHGRID_MAX_PARTS; ++i) {
    if (bytes[192U + 20U * i + 16U] > DEPTHGRID_BEYOND_RHO) {
      return DEPTHGRID_DATAGRAM_CONTENT_WRONG;
    }
  }
  answer->sequence = depthgrid_read_u64(bytes + 8);
  answer->time_s = depthgrid_read_double(bytes + 16);
  answer->exposure_s = depthgrid_read_double(bytes + 24);
  answer->state = bytes[32];
  answer->stop = bytes[33];
  answer->cameras = bytes[34];
  answer->parts = bytes[35];
  answer->late_cameras = depthgrid_read_u32(bytes + 36);
  answer->distance_m = depthgrid_read_float(bytes + 40);
  answer->clear_m = depthgrid_read_float(bytes + 44);
  answer->blind_m = depthgrid_read_float(bytes + 48);
  answer->skew_s = depthgrid_read_float(bytes + 52);
  answer->joints_age_s = depthgrid_read_float(bytes + 56);
  answer->latency_s = depthgrid_read_float(bytes + 60);
  for (i = 0; i < DEPTHGRID_MAX_CAMERAS; ++i) {
    answer->image_age_s[i] = depthgrid_read_float(bytes + 64 + 4 * i);
    answer->without_reading[i] = depthgrid_read_float(bytes + 128 + 4 * i);
  }
  for (i = 0; i < DEPTHGRID_MAX_PARTS; ++i) {
    const unsigned char* part = bytes + 192 + 20 * i;
    answer->part[i].distance_m = depthgrid_read_float(part);
    for (axis = 0; axis < 3; ++axis) {
      answer->part[i].nearest_m[axis] = depthgrid_read_float(part + 4 + 4 * axis);
    }
    answer->part[i].state = part[16];
  }
  return DEPTHGRID_DATAGRAM_OK;
}

/* NOLINTEND(modernize-use-nullptr,cppcoreguidelines-macro-usage,cppcoreguidelines-avoid-c-arrays,cppcoreguidelines-pro-type-cstyle-cast) */
/* NOLINTEND(modernize-deprecated-headers,modernize-use-using,modernize-avoid-c-arrays) */
#endif
