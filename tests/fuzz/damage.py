"""Damages of a file or of options, drawn from a seeded generator: what is written wrong, cut, torn or mixed up. Each returns
the damaged bytes and whether the meaning is kept."""

import re

NUMBER = re.compile(rb"(?<![\w.])[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?(?![\w.])")
WORDS = (b"nan", b"inf", b"-inf", b"1e400", b"-1", b"0", b"99999999999999999999", b"2147483648", b"-2147483649", b"", b"''",
         b"1e-320", b"1e300", b"0x10", b"1,2", b"--", b"true", b"\xc2\xb5", b"\xff\xfe", b"1.5", b"3", b"1e9", b"[]", b"~", b"7 8")


def truncate(random, data):
    return data[:random.randrange(len(data) + 1)], False


def flip(random, data):
    if not data:
        return data, True
    at = random.randrange(len(data))
    return data[:at] + bytes([data[at] ^ 1 << random.randrange(8)]) + data[at + 1:], False


def bytes_over(random, data):
    at, n = random.randrange(len(data) + 1), random.choice((1, 2, 4, 8, 64))
    return data[:at] + random.randbytes(n) + data[at + n:], False


def zeros_over(random, data):
    at, n = random.randrange(len(data) + 1), random.choice((1, 4, 8, 512))
    return data[:at] + bytes(n) + data[at + n:], False


def cut_out(random, data):
    at = random.randrange(len(data) + 1)
    return data[:at] + data[at + random.choice((1, 2, 4, 8, 100)):], False


def put_in(random, data):
    at = random.randrange(len(data) + 1)
    return data[:at] + random.randbytes(random.choice((1, 4, 8))) + data[at:], False


def append(random, data):
    return data + random.randbytes(random.choice((1, 4, 8, 1000))), False


def double_half(random, data):
    at = random.randrange(len(data) + 1)
    return data[:at] + data[:at] + data[at:], False


def line_out(random, data):
    lines = data.splitlines(keepends=True)
    if lines:
        del lines[random.randrange(len(lines))]
    return b"".join(lines), False


def line_twice(random, data):
    lines = data.splitlines(keepends=True)
    if lines:
        at = random.randrange(len(lines))
        lines.insert(random.randrange(len(lines) + 1), lines[at])
    return b"".join(lines), False


def lines_swapped(random, data):
    lines = data.splitlines(keepends=True)
    if len(lines) > 1:
        i, j = random.sample(range(len(lines)), 2)
        lines[i], lines[j] = lines[j], lines[i]
    return b"".join(lines), False


def words_swapped(random, data):
    words = re.split(rb"(\s+)", data)
    if len(words) > 4:
        i, j = (2 * k for k in random.sample(range(len(words) // 2), 2))
        words[i], words[j] = words[j], words[i]
    return b"".join(words), False


def number_replaced(random, data):
    found = list(NUMBER.finditer(data))
    if not found:
        return flip(random, data)
    number = random.choice(found)
    return data[:number.start()] + random.choice(WORDS) + data[number.end():], False


def number_off(random, data):
    """A count or index beside the right one."""
    found = [number for number in NUMBER.finditer(data) if number[0].isdigit()]
    if not found:
        return flip(random, data)
    number = random.choice(found)
    value = int(number[0]) + random.choice((-2, -1, 1, 2, 1000, 10 ** 9))
    return data[:number.start()] + str(value).encode() + data[number.end():], False


def letter_wrong(random, data):
    found = list(re.finditer(rb"[A-Za-z]", data))
    if not found:
        return flip(random, data)
    at = random.choice(found).start()
    return data[:at] + random.choice((b"", b"x", b"\xc3\xa9", b"_", b":")) + data[at + 1:], False


def unicode_mark(random, data):
    return random.choice((b"\xef\xbb\xbf", b"\xe2\x80\xa8", b"\x00")) + data, False


def windows(random, data):
    return re.sub(rb"\r?\n", b"\r\n", data), True


def blanks(random, data):
    return data.replace(b"\n", b" \n"), True


def lines_shuffled(random, data):
    """Of a YAML file whose keys have a line each."""
    lines = data.splitlines(keepends=True)
    random.shuffle(lines)
    return b"".join(lines), True


def nothing(random, data):
    return data, True


BYTES = (truncate, flip, flip, bytes_over, zeros_over, cut_out, put_in, append, double_half, nothing)
LINES = (truncate, flip, bytes_over, line_out, line_twice, lines_swapped, words_swapped, number_replaced, number_replaced,
         number_replaced, number_off, number_off, letter_wrong, unicode_mark, windows, blanks, append, nothing)
TEXT_OF_BINARY = (number_off, line_out, line_twice)
