"""A real ROS 2 node (rclpy on Fast DDS) and ours on one loopback: it sees our node, topics, types and type hashes, gets
what we send bit for bit, and we get what it sends. Usage: ros_node.py DDS_PEER"""

import os
import subprocess
import sys
import tempfile
import time

try:
    import rclpy
    from rclpy.qos import QoSDurabilityPolicy, QoSProfile, qos_profile_sensor_data
    from rclpy.signals import SignalHandlerOptions
    from sensor_msgs.msg import Image, JointState
    from std_msgs.msg import String
except ImportError as error:
    print(f"skipped: {error}; scripts/python-peers installs a ROS 2 node")
    sys.exit(77)

IMAGES = 30
WIDTH, HEIGHT = 640, 480


# Fast DDS on the loopback interface alone, as ours is.
PROFILE = """<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns="http://www.eprosima.com"><profiles>
  <transport_descriptors><transport_descriptor><transport_id>lo</transport_id><type>UDPv4</type>
    <interfaceWhiteList><address>127.0.0.1</address></interfaceWhiteList>
    <sendBufferSize>4194304</sendBufferSize><receiveBufferSize>4194304</receiveBufferSize></transport_descriptor></transport_descriptors>
  <participant profile_name="lo" is_default_profile="true"><rtps>
    <useBuiltinTransports>false</useBuiltinTransports>
    <userTransports><transport_id>lo</transport_id></userTransports></rtps></participant>
</profiles></dds>
"""


def numbered_pixels(number):
    """As tests/dds/loopback.cpp has them."""
    count = WIDTH * HEIGHT
    return b"".join(((n * 7919 + number * 104729) % 65536).to_bytes(2, "little") for n in range(count))


def wait(node, what, holds, seconds=30.0):
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end, f"not within {seconds} s: {what}"
        rclpy.spin_once(node, timeout_sec=0.05)


def main():
    domain = 210 + os.getpid() % 20
    profile = tempfile.NamedTemporaryFile("w", suffix=".xml")
    profile.write(PROFILE)
    profile.flush()
    os.environ.update(ROS_DOMAIN_ID=str(domain), ROS_AUTOMATIC_DISCOVERY_RANGE="SUBNET",
                      RMW_IMPLEMENTATION="rmw_fastrtps_cpp", FASTDDS_DEFAULT_PROFILES_FILE=profile.name)
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node("someone")
    images, joints, images_back, texts = [], [], [], []
    reliable = QoSProfile(depth=IMAGES + 10)
    node.create_subscription(Image, "/depth", images.append, reliable)
    node.create_subscription(Image, "/image_back", images_back.append, reliable)
    node.create_subscription(JointState, "/joint_states_back", joints.append, reliable)
    joint_publisher = node.create_publisher(JointState, "/joint_states", reliable)
    image_publisher = node.create_publisher(Image, "/image", qos_profile_sensor_data)

    peer = subprocess.Popen([sys.argv[1], str(domain), str(IMAGES)], stdin=subprocess.PIPE)
    try:
        wait(node, "our node's name", lambda: ("dds_peer", "/") in node.get_node_names_and_namespaces())
        expected = {
            "/depth": "sensor_msgs/msg/Image",
            "/joint_states_back": "sensor_msgs/msg/JointState",
            "/description": "std_msgs/msg/String",
            "/distances": "depthgrid_msgs/msg/Distances",
        }
        wait(node, "our topics", lambda: set(expected) <= {name for name, _ in node.get_topic_names_and_types()})
        types = dict(node.get_topic_names_and_types())
        for topic, name in expected.items():
            assert types[topic] == [name], (topic, types[topic])
            (info,) = node.get_publishers_info_by_topic(topic)
            assert info.topic_type_hash.version == 1, (topic, "has no valid type hash")
        for own, of_peer in (("/joint_states", "/joint_states_back"), ("/image", "/depth")):
            (mine,) = node.get_publishers_info_by_topic(own)
            (its,) = node.get_publishers_info_by_topic(of_peer)
            assert mine.topic_type_hash == its.topic_type_hash, (own, "and ours have different type hashes")

        # Which are whose is asked by node: of an endpoint Fast DDS learns no participant from Cyclone DDS, so that
        # "ros2 topic info -v" says _CREATED_BY_BARE_DDS_APP_, as of every Cyclone node.
        wait(node, "which topics are our node's",
             lambda: set(expected) <= {n for n, _ in node.get_publisher_names_and_types_by_node("dds_peer", "/")})
        heard = {n for n, _ in node.get_subscriber_names_and_types_by_node("dds_peer", "/")}
        assert {"/joint_states", "/image"} <= heard, heard

        wait(node, f"{IMAGES} images", lambda: len(images) == IMAGES)
        assert sorted(image.header.stamp.sec for image in images) == list(range(IMAGES))
        for image in images[:3] + images[-1:]:
            assert (image.width, image.height, image.encoding, image.step) == (WIDTH, HEIGHT, "16UC1", 2 * WIDTH)
            assert image.header.frame_id == "camera" and image.is_bigendian == 0
            assert bytes(image.data) == numbered_pixels(image.header.stamp.sec), "pixels differ"

        # What was said before this subscription was made.
        latched = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(String, "/description", texts.append, latched)
        wait(node, "the description", lambda: texts)
        assert texts[0].data == "<robot name='said once'/>", texts[0].data

        state = JointState(name=["a", "bcd"], position=[0.125, -3.5], velocity=[1e-300, 7.0], effort=[0.0, -0.0])
        state.header.frame_id = "base"
        state.header.stamp.sec, state.header.stamp.nanosec = 1700000000, 999999999
        joint_publisher.publish(state)
        wait(node, "our joint state back", lambda: joints)
        assert joints[0] == state, joints[0]

        sent = Image(width=WIDTH, height=HEIGHT, encoding="16UC1", step=2 * WIDTH, data=numbered_pixels(77))

        def again():
            image_publisher.publish(sent)  # best effort: it may get lost
            return len(images_back) > 0

        wait(node, "our image back", again)
        assert images_back[0] == sent, "the image that came back differs"
    finally:
        peer.stdin.close()
        code = peer.wait(timeout=20)
    assert code == 0, f"dds_peer ended with {code}"
    rclpy.shutdown()
    print(f"rclpy and ours: node, {len(expected)} topics, hashes, {IMAGES} images, a joint state and an image back, all equal")


main()
