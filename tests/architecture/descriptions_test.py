"""Every field of a described type is in its description: what stores, compares and keys it would miss it otherwise."""

import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1])
# What is left out of a description on purpose, with the reason.
LEFT_OUT = {
    ("CaseFile", "file"): "where it was read from is no setting",
    ("CaseFile", "folder"): "where it was read from is no setting",
    ("ProgramPose", "R_robot_tool"): "a file holds the same rotation as rotation_vector",
    ("VerificationCheck", "plot"): "it is drawn, and no file holds it",
}
BY_A_TABLE = {"Specimen"}  # described by the table of its parameters
OPTIONS_ALONE = {"EvaluateRequest", "ExportRequest"}  # a command's description of its options: neither stored nor compared


def without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)


def body_from(text, start):
    """The text between the brace at `start` and the one that closes it."""
    depth = 0
    for i in range(start, len(text)):
        depth += {"{": 1, "}": -1}.get(text[i], 0)
        if depth == 0:
            return text[start + 1:i]
    raise ValueError("a brace that is not closed")


def statements(body):
    """Declarations at the top of a struct's body. A function's body ends its statement."""
    depth, text = 0, ""
    for c in body:
        depth += {"{": 1, "(": 1, "}": -1, ")": -1}.get(c, 0)
        text += c
        if depth == 0 and (c == ";" or (c == "}" and re.match(r"[^={]*\([^{]*\{", text, flags=re.S))):
            yield text
            text = ""


def flat(text, opening, closing):
    """Without what stands between these brackets, however deep."""
    depth, kept = 0, ""
    for c in text:
        depth += c == opening
        kept += c if depth == 0 else ""
        depth -= c == closing
    return kept


def fields(body):
    for statement in statements(body):
        declaration = flat(flat(statement.split(";")[0], "{", "}"), "<", ">").strip()
        if not declaration or "(" in declaration.split("=")[0] or re.match(r"(static|using|enum|struct|class|friend|template|typedef)\b|.*\boperator\b", declaration):
            continue
        for part in flat(declaration, "(", ")").split(","):
            found = re.search(r"(\w+)\s*$", part.split("=")[0].strip())
            if found:
                yield found.group(1)


def main():
    texts = {file: without_comments(file.read_text()) for folder in ("include", "src") for file in sorted((ROOT / folder).rglob("*.[hc]pp"))}
    described, faults = {}, []  # fields by the type's name
    for file, text in texts.items():
        # A description may be in parts, and out of its header.
        for found in re.finditer(r"\bvoid describe\w*\(Visitor& v, (?:const Field& \w+, )?(\w+)(?:<\w+>)?& (\w+)\) \{", text):
            name, variable = found.groups()
            description = body_from(text, found.end() - 1)
            described.setdefault(name, set()).update(re.findall(rf"\b{variable}\.(\w+)", description))
    types = 0
    for file, text in texts.items():
        for declared in re.finditer(r"\bstruct (?:\[\[nodiscard\]\] )?(\w+) \{", text):
            name = declared.group(1)
            if name not in described or name in BY_A_TABLE | OPTIONS_ALONE or (file.suffix == ".cpp" and "describe(Visitor& v, " + name not in text):
                continue
            types += 1
            for field in fields(body_from(text, declared.end() - 1)):
                if field not in described[name] and (name, field) not in LEFT_OUT:
                    faults.append(f"{file.relative_to(ROOT)}: {name}::{field} is not in its description")
    print(f"{types} described types")
    print("\n".join(faults))
    assert types > 60, "the search has gone blind"
    # It sees what is missing.
    assert list(fields("double a = 0.0; std::map<std::string, int> b; int c{3}, d; [[nodiscard]] int e() const { return a; } static int f; std::array<double, 2> g{};")) == \
        ["a", "b", "c", "d", "g"]
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
