"""Circles of files: files of C of which each calls functions of the next one, and the last of the first."""

import re


def calls(sources):
    """File -> files whose functions it names."""
    home = {f.name: s.path for s in sources if s.path.suffix == ".c" for f in s.functions}
    return {s.path: {home[word] for word in re.findall(r"\w+", s.code) if word in home} - {s.path}
            for s in sources if s.path.suffix == ".c"}


def reached(graph, start):
    """Files that calls lead to from one file."""
    found, left = set(), [start]
    while left:
        for path in graph[left.pop()] - found:
            found.add(path)
            left.append(path)
    return found


def circles_of(sources):
    """The circles, each a sorted list of files."""
    graph = calls(sources)
    reach = {path: reached(graph, path) for path in graph}
    members = {tuple(sorted(other for other in reach[path] if path in reach[other])) for path in graph if path in reach[path]}
    return sorted(members)
