"""MCAP files beside the packages mcap and rosbags: what we write they read, CRCs checked, and the other way round.

Usage: mcap_peer.py MCAP_PEER    (the program built from mcap_peer.cpp)
"""
import itertools
import pathlib
import subprocess
import sys
import tempfile

import numpy
from mcap.reader import make_reader
from mcap.records import Channel, Message, Schema
from mcap.stream_reader import StreamReader
from mcap.writer import CompressionType, IndexType, Writer
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as BagWriter
from rosbags.typesys import Stores, get_typestore

PEER = sys.argv[1]


def rows(*words):
    done = subprocess.run([PEER, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == 0, f"{words}: {done.stderr}"
    return [tuple(line.split("\t")) for line in done.stdout.splitlines()]


def row(topic, kind, sequence, log_time, publish_time, data):
    return (topic, kind, str(sequence), str(log_time), str(publish_time), bytes(data).hex())


def by_stream(file):
    """Record by record, with the CRCs of chunks and of the data section."""
    schemas, channels, found = {}, {}, []
    with open(file, "rb") as stream:
        for record in StreamReader(stream, validate_crcs=True).records:
            if isinstance(record, Schema):
                schemas[record.id] = record
            elif isinstance(record, Channel):
                channels[record.id] = record
            elif isinstance(record, Message):
                channel = channels[record.channel_id]
                found.append(row(channel.topic, schemas[channel.schema_id].name, record.sequence, record.log_time,
                                 record.publish_time, record.data))
    return found


def by_index(file):
    with open(file, "rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        summary = reader.get_summary()
        assert summary is not None and summary.statistics is not None
        found = [row(channel.topic, schema.name, message.sequence, message.log_time, message.publish_time, message.data)
                 for schema, channel, message in reader.iter_messages(log_time_order=False)]
        statistics = summary.statistics
        assert statistics.message_count == len(found), statistics
        assert sum(statistics.channel_message_counts.values()) == len(found), statistics
        assert statistics.chunk_count == len(summary.chunk_indexes) > 0, statistics
        assert (statistics.channel_count, statistics.schema_count) == (len(summary.channels), len(summary.schemas)), statistics
        assert statistics.message_start_time == min(int(r[3]) for r in found), statistics
        assert statistics.message_end_time == max(int(r[3]) for r in found), statistics
        assert reader.get_header().profile == "ros2"
        return found


def check_ours(folder):
    """Written by us, read by both."""
    for compression, chunk_bytes in itertools.product(("none", "lz4", "zstd"), (1, 20_000, 4_000_000)):
        file = folder / f"ours-{compression}-{chunk_bytes}.mcap"
        written = rows("write", file, compression, chunk_bytes)
        assert len(written) == 21
        assert by_stream(file) == written, f"{file.name}: mcap's stream reader"
        assert sorted(by_index(file)) == sorted(written), f"{file.name}: mcap's indexed reader"
        images = []
        with AnyReader([file]) as reader:
            found = []
            for connection, time, raw in reader.messages():
                found.append((connection.topic, connection.msgtype, str(time), bytes(raw).hex()))
                message = reader.deserialize(raw, connection.msgtype)
                if connection.msgtype == "sensor_msgs/msg/Image":
                    images.append(message)
                elif connection.msgtype == "depthgrid_msgs/msg/Distances":
                    assert message.distances[0].id == "hand" and numpy.isnan(message.distances[0].distance_now)
                    assert message.cameras == ["cam"] and list(message.image_ages) == [0.25]
            assert found == [(r[0], r[1], r[3], r[5]) for r in written], f"{file.name}: rosbags"
            profiles = {c.topic: c.ext.offered_qos_profiles for c in reader.connections}
            assert profiles["/tf_static"][0].durability.name == "TRANSIENT_LOCAL", profiles
        for i, image in enumerate(images):
            expected = ((numpy.arange(64 * 48) * 31 + i) % 65536).astype("<u2")
            assert (image.data.view("<u2") == expected).all() and image.header.frame_id == "cam"
        assert len(images) == 10


def check_mcap_package(folder):
    """Written by mcap in every form that it knows, read by us."""
    count = 0
    for compression, chunking, indexes, repeated, statistics in itertools.product(
            CompressionType, (True, False), (IndexType.ALL, IndexType.NONE, IndexType.CHUNK), (True, False), (True, False)):
        file = folder / f"mcap-{count}.mcap"
        count += 1
        with open(file, "wb") as stream:
            writer = Writer(stream, chunk_size=200, compression=compression, index_types=indexes, use_chunking=chunking,
                            repeat_channels=repeated, repeat_schemas=repeated, use_statistics=statistics,
                            use_summary_offsets=repeated, enable_data_crcs=statistics)
            writer.start(profile="ros2")
            schema = writer.register_schema("std_msgs/msg/String", "ros2msg", b"string data")
            channels = [writer.register_channel(topic, "cdr", schema) for topic in ("/a", "/b")]
            writer.add_metadata("some", {"key": "value"})
            expected = []
            for i in range(20):
                data = bytes([i]) * (i * 7)
                writer.add_message(channels[i % 2], 1000 - 3 * i, data, 900 + i, sequence=i)
                expected.append(row("/ab"[0] + "ab"[i % 2], "std_msgs/msg/String", i, 1000 - 3 * i, 900 + i, data))
            writer.add_attachment(1, 2, "a file", "text/plain", b"text")
            writer.finish()
        assert rows("read", file) == expected, f"{file.name}: {compression} {chunking} {indexes} {repeated} {statistics}"
    return count


def check_rosbags(folder):
    """A ROS 2 bag as rosbags writes it."""
    store = get_typestore(Stores.ROS2_JAZZY)
    bag = folder / "bag"
    expected = []
    with BagWriter(bag, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection("/text", "std_msgs/msg/String", typestore=store)
        for i in range(30):
            raw = bytes(store.serialize_cdr(store.types["std_msgs/msg/String"](data=f"text {i}"), "std_msgs/msg/String"))
            writer.write(connection, 10**18 + i, raw)
            expected.append(("/text", "std_msgs/msg/String", str(10**18 + i), raw.hex()))
    (file,) = bag.glob("*.mcap")
    assert [(r[0], r[1], r[3], r[5]) for r in rows("read", file)] == expected


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        check_ours(folder)
        count = check_mcap_package(folder)
        check_rosbags(folder)
    print(f"9 files of ours, {count} of mcap, one of rosbags")


main()
