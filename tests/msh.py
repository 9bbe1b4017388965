"""Files of Gmsh, in text."""


def sections(path):
    """Numbers and words of each section of a file, line by line."""
    found, name = {}, None
    for line in path.read_text().splitlines():
        if line.startswith("$"):
            name = None if line.startswith("$End") else line[1:]
            found.setdefault(name, [])
        else:
            found[name].append(line.split())
    return found
