"""Pages of the book that aren't written by hand: the notebook, the reference of the Python package from its docstrings,
and a page for each case of the validation.

    python3 docs/book_pages.py FOLDER     FOLDER is the root of a copy of the pages
"""

import ast
import base64
import inspect
import json
import pathlib
import re
import sys

PACKAGE = "python/contact_dd"
NOTEBOOK, REFERENCE = "docs/tutorials/python-notebook.md", "docs/python-reference.md"


def notebook(source, target):
    """Writes a notebook as a page, its pictures beside it."""
    parts = []
    for cell in json.loads(source.read_text())["cells"]:
        text = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(text)
            continue
        parts.append(f"```python\n{text}\n```")
        for output in cell["outputs"]:
            data = output.get("data", {})
            if "image/png" in data:
                picture = target.with_name(f"{target.stem}-{len(parts)}.png")
                picture.write_bytes(base64.b64decode("".join(data["image/png"])))
                parts.append(f"![What the cell above draws]({picture.name})")
            elif text := "".join(output.get("text", data.get("text/plain", ""))).strip():
                parts.append(f"```text\n{text}\n```")
    link = "It is a [notebook](python.ipynb) to run and change."
    target.write_text("\n\n".join([parts[0], link, *parts[1:]]) + "\n")


def signature(function):
    """Name and arguments of a function, a line for each argument where they are many."""
    arguments = ast.unparse(function.args).removeprefix("self, ").removeprefix("self").removeprefix("cls, ")
    returns = f" -> {ast.unparse(function.returns)}" if function.returns else ""
    return f"{function.name}({arguments}){returns}"


def fields(body):
    """Annotated names of a class, each with the text behind it."""
    for one, after in zip(body, [*body[1:], None], strict=True):
        if isinstance(one, ast.AnnAssign):
            is_text = isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
            text = inspect.cleandoc(after.value.value).replace("\n", " ") if is_text else ""
            yield ast.unparse(one.target), ast.unparse(one.annotation), text


def of_class(node):
    """A class: its text, its fields, its methods."""
    yield f"## `{node.name}`\n\n{ast.get_docstring(node) or ''}"
    found = [(name, kind, text) for name, kind, text in fields(node.body) if not name.startswith("_")]
    if found:
        rows = [f"| `{name}` | `{kind}` | {text} |".replace(" | None", " \\| None") for name, kind, text in found]
        yield "| | | |\n|---|---|---|\n" + "\n".join(rows)
    for one in node.body:
        is_public = isinstance(one, ast.FunctionDef) and (not one.name.startswith("_") or one.name == "__init__")
        if is_public and (text := ast.get_docstring(one)):
            yield f"### `{node.name}.{one.name}`\n\n```text\n{signature(one)}\n```\n\n{text}"


def reference(package, target):
    """Writes what the package exports, by its docstrings."""
    tree = ast.parse((package / "__init__.py").read_text())
    parts = ["# Python reference", "What `contact_dd` exports, from its docstrings; [Python](python.md) shows how it is used."]
    for imported in [one for one in tree.body if isinstance(one, ast.ImportFrom)]:
        module = ast.parse((package / f"{imported.module.split('.')[-1]}.py").read_text())
        nodes = {one.name: one for one in module.body if isinstance(one, ast.ClassDef | ast.FunctionDef)}
        for name in (alias.name for alias in imported.names):
            node = nodes[name]
            if isinstance(node, ast.ClassDef):
                parts += of_class(node)
            else:
                parts.append(f"## `{name}`\n\n```text\n{signature(node)}\n```\n\n{ast.get_docstring(node)}")
    target.write_text("\n\n".join(parts) + "\n")


def anchor_of(title):
    """The anchor of a heading, which is the name of its page."""
    return "".join(c for c in title.lower() if c.isalnum() or c in "-_ ").replace(" ", "-")


def cases(root):
    """Gives each case of the validation a page of its own; returns their lines of the summary."""
    page, folder = root / "docs/validation.md", root / "docs/validation"
    folder.mkdir()
    head, overview, *chapters = re.split(r"^## ", page.read_text(), flags=re.MULTILINE)
    lines = []
    for chapter in chapters:
        title, text = chapter.split("\n", 1)
        # Pages of cases lie a folder deeper.
        text = re.sub(r"\]\((?!https?:|#)", "](../", text)
        (folder / f"{anchor_of(title)}.md").write_text(f"# {title}\n{text}")
        lines.append(f"  - [{title}](docs/validation/{anchor_of(title)}.md)\n")
    page.write_text(re.sub(r"\]\(#([^)]+)\)", r"](validation/\1.md)", f"{head}## {overview}"))
    for other in root.rglob("*.md"):
        text = other.read_text()
        if "validation.md#" in text:
            other.write_text(re.sub(r"validation\.md#([^)]+)\)", r"validation/\1.md)", text))
    return "".join(lines)


def main():
    root = pathlib.Path(sys.argv[1])
    of_cases = cases(root)
    notebook(root / "docs/tutorials/python.ipynb", root / NOTEBOOK)
    reference(root / PACKAGE, root / REFERENCE)
    # Links to the notebook lead to its page, and both have their places in the book.
    for page in root.glob("docs/**/*.md"):
        if page != root / NOTEBOOK:
            page.write_text(page.read_text().replace("python.ipynb)", "python-notebook.md)"))
    summary = root / "SUMMARY.md"
    text = summary.read_text()
    text = text.replace("- [Python](docs/python.md)\n", f"- [Python](docs/python.md)\n- [Python reference]({REFERENCE})\n")
    text = text.replace("- [Validation](docs/validation.md)\n", f"- [Validation](docs/validation.md)\n{of_cases}")
    start = "- [Run your deck]"
    summary.write_text(text.replace(start, f"- [A model in Python, a notebook]({NOTEBOOK})\n{start}"))


main()
