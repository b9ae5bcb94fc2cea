"""A cell's recording beside the packages mcap and rosbags: they read it, CRCs checked, and find what answers stand on.

Usage: recording_peer.py DEPTHGRID    (in the folder of the sources)
"""
import collections
import pathlib
import subprocess
import sys
import tempfile

from mcap.reader import make_reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore


def register(store, name, definition):
    head, *parts = definition.split("=" * 80 + "\n")
    types = get_types_from_msg(head, name)
    for part in parts:
        title, _, fields = part.partition("\n")
        package, short = title.removeprefix("MSG: ").split("/")
        types.update(get_types_from_msg(fields, f"{package}/msg/{short}"))
    store.register({key: value for key, value in types.items() if key not in store.fielddefs})


def nanoseconds(stamp):
    return stamp.sec * 1_000_000_000 + stamp.nanosec


def main():
    command = sys.argv[1]
    cell = pathlib.Path("examples/simulated_cell.yaml").read_text()
    cell = cell[:cell.index("outputs:")] + "outputs: {terminal: false}\n"
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "cell.yaml").write_text(cell)
        subprocess.run([command, "run", "cell.yaml", "--seconds", "4", "--record", "run.mcap"], cwd=folder, check=True,
                       capture_output=True)
        with (folder / "run.mcap").open("rb") as file:
            reader = make_reader(file, validate_crcs=True)
            metadata = {entry.name: entry.metadata for entry in reader.iter_metadata()}
            assert metadata["depthgrid"]["cell"] == cell
            assert set(metadata) == {"depthgrid", "depthgrid end"}, metadata
            summary = reader.get_summary()
            store = get_typestore(Stores.ROS2_JAZZY)
            messages = collections.defaultdict(list)
            for schema, channel, message in reader.iter_messages():
                if schema.name not in store.fielddefs:
                    register(store, schema.name, schema.data.decode())
                messages[channel.topic].append((message, store.deserialize_cdr(message.data, schema.name)))
            for channel_id, channel in summary.channels.items():
                counted = summary.statistics.channel_message_counts.get(channel_id, 0)
                assert counted == len(messages[channel.topic]), channel.topic
                schema = summary.schemas[channel.schema_id].name
                if schema in store.fielddefs:
                    assert channel.metadata["topic_type_hash"] == store.hash_rihs01(schema), channel.topic
    images = [{nanoseconds(image.header.stamp) for _, image in messages[f"/{name}/depth/image_raw"]}
              for name in ("front", "back", "side")]
    joints = {nanoseconds(state.header.stamp) for _, state in messages["/joint_states"]}
    stood_on_all = 0
    for _, answer in messages["/distances"]:
        assert answer.cameras == ["front", "back", "side"]
        stamps = [nanoseconds(stamp) for stamp in answer.image_stamps]
        assert all(stamp == 0 or stamp in of for stamp, of in zip(stamps, images)), stamps
        assert all(nanoseconds(stamp) in joints | {0} for stamp in [*answer.image_joint_stamps, answer.joint_stamp])
        stood_on_all += all(stamps)
    assert stood_on_all > 20, stood_on_all
    for message, image in messages["/front/depth/image_raw"]:
        assert image.encoding == "16UC1" and len(image.data) == 2 * image.width * image.height
        assert message.log_time == nanoseconds(image.header.stamp)
    assert messages["/events"] and messages["/tf_static"]
    print(f"{len(messages['/distances'])} answers, {sum(map(len, images))} images, {len(joints)} joint states")


main()
