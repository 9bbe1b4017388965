"""Names that a case of tests/run.py may give: one that is misspelt would leave a run or a check out."""

CASE = {"options", "ranks", "make", "night_make", "needs", "file", "run", "check"}
RUN = {"options", "night_options", "ranks", "night", "stdout", "files", "link", "file_limit", "warning", "error", "hard", "wrong", "why"}
CHECK = {"run", "ranks", "table", "column", "where", "equals", "equals_run", "across_ranks", "pairs", "min", "max", "count", "rtol",
         "atol", "hard", "wrong", "why", "command"}


def fault_of_keys(case):
    """That a case runs nothing, or the first name of a case, a run or a check that nothing reads; None where all is right."""
    if not case.get("run"):
        return "the case has no run"
    tables = [("case", CASE, case), *((f"run {name}", RUN, run) for name, run in case["run"].items()),
              *(("a check", CHECK, check) for check in case.get("check", []))]
    return next((f"{each} has '{key}', which nothing reads" for each, known, table in tables for key in table if key not in known), None)
