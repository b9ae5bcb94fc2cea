"""Messages beside rosbags, which has its own definitions, serialisation and hashes.

Usage: messages_peer.py MESSAGE_PEER    (the program built from message_peer.cpp)
"""
import random
import struct
import subprocess
import sys

import numpy
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

PEER = sys.argv[1]
ROUNDS = 40


def lines_of_types():
    text = subprocess.run([PEER, "types"], check=True, capture_output=True, text=True).stdout
    for line in text.splitlines():
        name, dds_name, type_hash, definition = line.split("\t")
        yield name, dds_name, type_hash, definition.replace("\\n", "\n")


def parsed(name, definition):
    """The types of a definition as MCAP holds it, by our text alone."""
    head, *parts = definition.split("=" * 80 + "\n")
    types = get_types_from_msg(head, name)
    for part in parts:
        title, _, fields = part.partition("\n")
        package, short = title.removeprefix("MSG: ").split("/")
        types.update(get_types_from_msg(fields, f"{package}/msg/{short}"))
    return types


NUMBERS = {"bool": None, "byte": numpy.uint8, "uint8": numpy.uint8, "int32": numpy.int32, "uint32": numpy.uint32,
           "uint64": numpy.uint64,
           "float32": numpy.float32, "float64": numpy.float64}


def random_number(kind, dice):
    if kind == "bool":
        return dice.random() < 0.5
    if kind == "string":
        return "".join(dice.choice("abcä/_ ") for _ in range(dice.randrange(9)))
    if kind.startswith("float"):
        return float(NUMBERS[kind](dice.choice([0, -1.5, 1e-30, dice.gauss(0, 100), float("inf")])))
    if kind in ("byte", "octet"):
        return dice.randrange(128)  # rosbags takes it for signed
    limits = numpy.iinfo(NUMBERS[kind])
    return dice.randint(int(limits.min), int(limits.max))


def random_value(store, field, dice):
    """As rosbags' deserialised messages have it."""
    node, detail = field
    if node.name == "BASE":
        return random_number(detail[0], dice)
    if node.name == "NAME":
        return random_message(store, detail, dice)
    (element, kind), length = detail
    count = length if node.name == "ARRAY" else dice.randrange(4)
    if element.name == "BASE" and kind[0] in NUMBERS and kind[0] != "bool":
        return numpy.array([random_number(kind[0], dice) for _ in range(count)], dtype=NUMBERS[kind[0]])
    return [random_value(store, (element, kind), dice) for _ in range(count)]


def random_message(store, name, dice):
    fields = store.fielddefs[name][1]
    return store.types[name](**{field: random_value(store, kind, dice) for field, kind in fields})


def echoed(name, messages):
    sent = b"".join(struct.pack("<I", len(raw)) + raw for raw in messages)
    back = subprocess.run([PEER, "echo", name], check=True, input=sent, capture_output=True).stdout
    at = 0
    while at < len(back):
        (size,) = struct.unpack_from("<I", back, at)
        yield back[at + 4 : at + 4 + size]
        at += 4 + size


def main():
    dice = random.Random(1)
    stores = [get_typestore(store) for store in (Stores.ROS2_HUMBLE, Stores.ROS2_IRON, Stores.ROS2_JAZZY)]
    types = 0
    messages = 0
    for name, dds_name, type_hash, definition in lines_of_types():
        own = get_typestore(Stores.EMPTY)
        own.register(parsed(name, definition))
        assert own.hash_rihs01(name) == type_hash, f"{name}: rosbags says {own.hash_rihs01(name)} of our definition, we {type_hash}"
        if not name.startswith("depthgrid_msgs/"):
            for store in stores:  # what rosbags knows of the type by itself
                assert store.hash_rihs01(name) == type_hash, f"{name}: ROS's own hash is {store.hash_rihs01(name)}"
                assert store.fielddefs[name][1] == own.fielddefs[name][1], f"{name}: its fields are others"
        little = []
        big = []
        for _ in range(ROUNDS):
            message = random_message(own, name, dice)
            little.append(bytes(own.serialize_cdr(message, name, little_endian=True)))
            big.append(bytes(own.serialize_cdr(message, name, little_endian=False)))
            own.deserialize_cdr(little[-1], name)
        assert list(echoed(name, little)) == little, f"{name}: little endian comes back changed"
        assert list(echoed(name, big)) == little, f"{name}: big endian comes back changed"
        types += 1
        messages += 2 * ROUNDS
    assert types == 9
    print(f"{types} types, {messages} messages")


main()
