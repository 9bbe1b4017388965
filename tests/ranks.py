"""Numbers of ranks on which the runs of a case of tests/run.py are made, by day and by night."""

import re


def fault_of_ranks(case):
    """What is wrong with the numbers of ranks of a case: a run on none that the case makes, or a comparison that no day or night makes."""
    own = case.get("ranks", [1])
    for name, run in case["run"].items():
        if not set(run.get("ranks", own)) <= set(own):
            return f"run {name} is on ranks that the case is not made on"
    for check in case.get("check", []):
        name = check.get("run", next(iter(case["run"])))
        run = case["run"][name]
        if "across_ranks" in check and len({*run.get("ranks", own), *run.get("night", [])}) < 2:
            return f"across_ranks of {name}, which is made on one number of ranks by day and by night"
        met = [{*case["run"][each].get("ranks", own), *case["run"][each].get("night", [])} for each in runs_of(check, case["run"])]
        if not set.intersection(*met):
            return f"check '{check.get('why', name)}' compares runs that are never made on the same number of ranks"
    return None


def runs_of(check, runs):
    """Names of the runs that a check looks at."""
    named = {check.get("run"), check.get("equals_run"), *re.findall(r"{(\w+)}", check.get("command", ""))}
    return named & set(runs) or {next(iter(runs))}


def ranks_of_runs(case, chosen, night):
    """Gives each run its numbers of ranks, by night those of the night too; all of these, in order, with `chosen` first. By day three
    of four bad inputs are tried on one rank in place of several, where a run begins much sooner."""
    alone = re.compile("|".join(f"{{{name}}}" for name in case["run"]))  # without the results of another run
    bad = [run for run in case["run"].values() if "error" in run and "ranks" not in run and not alone.search(str(run))]
    for run in case["run"].values():
        run["ranks"] = run.get("ranks", chosen) + (run.get("night", []) if night else [])
    for k, run in enumerate(bad):
        if not night and k % 4:
            run["ranks"] = [1]
    return chosen + sorted({ranks for run in case["run"].values() for ranks in run["ranks"]} - set(chosen))
