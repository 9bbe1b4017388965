"""C and Python files as the rules of the house see them (test_house.py): definitions with their lines, without a compiler.
In C, comments and strings are blanked out, so that every character keeps its place; what stands at depth 0 of the braces
is read."""

import ast
import re
from collections import Counter, namedtuple

NOISE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.DOTALL)
DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", re.MULTILINE)
ATTRIBUTE = re.compile(r"__attribute__\s*\(\(.*?\)\)|PETSC_ATTRIBUTE_FORMAT\([^)]*\)", re.DOTALL)

Function = namedtuple("Function", "name line static n_arguments n_lines begin end")
Name = namedtuple("Name", "kind name line")


def blank(match):
    """Spaces as long as what was matched, on as many lines; of a string the quotes remain."""
    text = match.group(0)
    kept = re.sub(r"[^\n]", " ", text)
    return text[0] + kept[1:-1] + text[-1] if text[0] in "\"'" else kept


class Source:
    """One C file: text, code (without comments and strings), functions, names of types, macros and constants."""

    def __init__(self, path):
        self.path = path
        self.text = path.read_text()
        self.code = NOISE.sub(blank, self.text)
        self.words = Counter(re.findall(r"\w+", self.code))
        self.functions, self.names = [], []
        self.read_macros()
        self.read_items(ATTRIBUTE.sub(blank, DIRECTIVE.sub(blank, self.code)))

    def line(self, at):
        """Number of the line of a character, from 1."""
        return self.code.count("\n", 0, at) + 1

    def read_macros(self):
        seen = set()
        for macro in re.finditer(r"^[ \t]*#[ \t]*define[ \t]+(\w+)", self.code, re.MULTILINE):
            if macro[1] not in seen:  # a file may define a macro once in each branch of an #if
                self.names.append(Name("macro", macro[1], self.line(macro.start(1))))
            seen.add(macro[1])

    def read_items(self, code):
        """Splits the file into functions and declarations, each up to its closing brace or semicolon."""
        begin, depth, brace, seen = 0, 0, None, set()
        for found in re.finditer(r"[{};]", code):
            at = found.start()
            if found[0] == "{":
                brace = at if depth == 0 and brace is None else brace
                depth += 1
            elif found[0] == "}":
                depth -= 1
                if depth == 0 and self.read_function(code, begin, brace, at):
                    begin, brace = at + 1, None
            elif depth == 0:
                for name in declared(code[begin:at + 1], begin, self.line):
                    if name[:2] not in seen:
                        self.names.append(name)
                    seen.add(name[:2])
                begin, brace = at + 1, None

    def read_function(self, code, begin, brace, end):
        """Keeps the function whose body is between brace and end; false where it is none."""
        head = code[begin:brace].rstrip()
        named = re.search(r"(\w+)\s*\(", head)
        if not named or not head.endswith(")") or "=" in head:
            return False
        static = re.search(r"\b(static|INTO_VERSIONS|STENCIL_INLINE)\b", head) is not None
        n_arguments = count_arguments(head[named.end():-1])
        n_lines = max(code.count("\n", brace, end) - 1, 0)
        line = self.line(begin + named.start())
        self.functions.append(Function(named[1], line, static, n_arguments, n_lines, brace, end))
        return True


def count_arguments(text):
    """Number of arguments of a list; the dots of printf() are none."""
    depth, n = 0, 1
    for c in text:
        depth += (c in "([{") - (c in ")]}")
        n += c == "," and depth == 0
    if text.strip() in ("", "void"):
        return 0
    return n - (1 if text.strip().endswith("...") else 0)


def declared(text, at, line):
    """Types and enumerators of a declaration at depth 0, which ends with its semicolon."""
    for tag in re.finditer(r"\b(struct|union|enum)\s+(\w+)\s*\{", text):
        yield Name(tag[1], tag[2], line(at + tag.start(2)))
    for members in re.finditer(r"\benum\b\s*\w*\s*\{([^}]*)\}", text):
        for word in re.finditer(r"(?:^|,)\s*(\w+)", members[1]):
            yield Name("constant", word[1], line(at + members.start(1) + word.start(1)))
    if not re.match(r"\s*typedef\b", text):
        return
    flat = re.sub(r"\{.*\}", lambda m: re.sub(r"[^\n]", " ", m[0]), text, flags=re.DOTALL)
    forms = (r"\(\s*\*\s*(\w+)\s*\)\s*\(", r"(\w+)\s*\([^()]*\)\s*;$", r"(\w+)\s*(?:\[[^\]]*\]\s*)*;$")
    name = next(filter(None, (re.search(form, flat) for form in forms)))
    yield Name("type", name[1], line(at + name.start(1)))


def together(counters):
    """The sum of counters. Adding them one by one would copy the sum each time."""
    total = Counter()
    for counter in counters:
        total.update(counter)
    return total


class Script:
    """One Python file: text, functions and classes, names that it imports and does not use."""

    def __init__(self, path):
        self.path = path
        self.text = path.read_text()
        nodes = nodes_of(ast.parse(self.text))
        self.definitions = [node for node in nodes if isinstance(node, (ast.FunctionDef, ast.ClassDef))]
        used = {node.id for node in nodes if isinstance(node, ast.Name)}
        self.unused = sorted({(name, node.lineno) for node in nodes if isinstance(node, (ast.Import, ast.ImportFrom))
                              for name in map(imported_name, node.names) if name not in used and not self.excused(node)})

    def excused(self, node):
        """Whether the line of an import says that nothing uses it here."""
        return "noqa" in self.text.splitlines()[node.lineno - 1]


def nodes_of(tree):
    """All nodes of a tree, which ast.walk() takes three times as long for."""
    found = [tree]
    for node in found:  # which grows
        for value in vars(node).values():
            if isinstance(value, ast.AST):
                found.append(value)
            elif isinstance(value, list):
                found += [item for item in value if isinstance(item, ast.AST)]
    return found


def imported_name(alias):
    """What a name of an import statement is called after it."""
    return alias.asname or alias.name.split(".")[0]
