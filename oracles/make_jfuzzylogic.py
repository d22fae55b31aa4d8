"""Connectives, ranks, sets and accumulations as jFuzzyLogic 3.3 has them: one system, rules about it, and what it answers.

Needs a Java compiler, and jFuzzyLogic's classes with those that they need: `make_jfuzzylogic.py CLASS_PATH`.
"""
import pathlib
import subprocess
import sys
import tempfile

import fixture

FOLDER = fixture.CRATES / "fspid-formats/tests/data/fcl"
# `//` marks the dialect. What stands in square brackets is put in.
SYSTEM = """// A system to be asked by jFuzzyLogic's ways
FUNCTION_BLOCK asked
VAR_INPUT x : REAL; y : REAL; END_VAR
VAR_OUTPUT z : REAL; v : REAL; END_VAR
FUZZIFY x
  TERM a := (0, 0) (10, 1);
  TERM b := (0, 1) (10, 0);
  TERM c := COSINE 3 4;
  TERM d := DSIGM 2 3 1 6;
  TERM e := DSIGM 1 6 2 3;
END_FUZZIFY
FUZZIFY y
  TERM a := (0, 0) (10, 1);
  TERM b := (0, 1) (10, 0);
END_FUZZIFY
DEFUZZIFY z TERM l := 0; TERM h := 10; METHOD : COGS; DEFAULT := -1; END_DEFUZZIFY
DEFUZZIFY v TERM l := (0, 1) (6, 0); TERM h := (2, 0) (10, 1); METHOD : COG; DEFAULT := -1; RANGE := (0 .. 10); END_DEFUZZIFY
RULEBLOCK one
[statements]
[rules]
END_RULEBLOCK
END_FUNCTION_BLOCK
"""
QUESTIONS = [(3, 6), (0.5, 9), (9, 8)]
WEIGHED = "IF x IS b THEN z IS l"
CONNECTIVES = ["AND : MIN;", "AND : PROD;", "AND : BDIF;", "AND : HAMACHER;", "AND : NIPMIN;", "AND : DMIN;",
               "OR : MAX;", "OR : ASUM;", "OR : BSUM;", "OR : EINSTEIN;", "OR : NIPMAX;", "OR : DMAX;", "",
               "AND : MIN; OR : ASUM;", "OR : ASUM; AND : MIN;", "AND : PROD; OR : MAX;", "OR : MAX; AND : PROD;"]
CONDITIONS = ["x IS a OR y IS a AND y IS b", "y IS b AND y IS a OR x IS a", "x IS a OR (y IS a AND y IS b)",
              "x IS a AND y IS b OR y IS a AND x IS b", "NOT x IS a AND y IS a", "NOT (x IS a AND y IS a)",
              "x IS c", "x IS d", "x IS e"]
ACCUMULATIONS = ["", "ACCU : MAX;", "ACCU : BSUM;", "ACCU : NSUM;", "ACCU : PROBOR;", "ACCU : SUM;"]
EQUAL = ["IF x IS a THEN z IS h; IF y IS a THEN z IS h; IF x IS b THEN z IS l",
         "IF x IS a AND y IS a THEN z IS h; IF x IS b OR y IS b THEN z IS h; IF x IS b THEN z IS l; IF y IS b THEN z IS l",
         "IF x IS a THEN v IS h; IF y IS a THEN v IS h; IF x IS b THEN v IS l"]
JAVA = """
import net.sourceforge.jFuzzyLogic.FIS;
public class Asked {
  public static void main(String[] lines) {
    for (int i = 0; i < lines.length; i += 3) {
      FIS fis = FIS.load(lines[i], false);
      fis.setVariable("x", Double.parseDouble(lines[i + 1]));
      fis.setVariable("y", Double.parseDouble(lines[i + 2]));
      fis.evaluate();
      System.out.println(fis.getVariable("z").getValue() + " " + fis.getVariable("v").getValue());
    }
  }
}
"""


def cases():
    """Statements of the rule block, and rules, several of them separated by semicolons."""
    for statements in CONNECTIVES:
        for connective in ["AND", "OR"]:
            yield statements, f"IF x IS a {connective} y IS a THEN z IS h; {WEIGHED}"
    for condition in CONDITIONS:
        yield "AND : PROD; ACCU : MAX;", f"IF {condition} THEN z IS h; {WEIGHED}"
    for statements in ACCUMULATIONS:
        for rules in EQUAL:
            yield f"AND : PROD; {statements}".strip(), rules
    yield "AND : MIN; ACCU : MAX;", "IF x IS a THEN z IS h WITH 0.5; IF y IS a THEN z IS h WITH 0.5; " + WEIGHED


def text(statements, rules):
    numbered = [f"  RULE {number} : {rule};" for number, rule in enumerate(rules.split("; "), 1)]
    return SYSTEM.replace("[statements]", f"  {statements}").replace("[rules]", "\n".join(numbered))


def answers(class_path, folder, asked):
    """What `z` and `v` are."""
    (folder / "Asked.java").write_text(JAVA)
    paths = f"{folder}:{class_path}"
    subprocess.run(["javac", "-cp", paths, "-d", folder, folder / "Asked.java"], check=True)
    arguments = []
    for index, (statements, rules, x, y) in enumerate(asked):
        file = folder / f"{index}.fcl"
        file.write_text(text(statements, rules))
        arguments += [file, str(x), str(y)]
    run = ["java", "-Djava.awt.headless=true", "-cp", paths, "Asked", *arguments]
    for line in subprocess.run(run, check=True, capture_output=True, text=True).stdout.splitlines():
        yield [float(word) for word in line.split()]


if __name__ == "__main__":
    asked = [(*case, x, y) for case in cases() for x, y in QUESTIONS]
    with tempfile.TemporaryDirectory() as folder:
        found = list(answers(sys.argv[1], pathlib.Path(folder), asked))
    if len(found) != len(asked):
        raise SystemExit("a question without an answer")
    (FOLDER / "asked-jfuzzylogic.fcl").write_text(SYSTEM, newline="\n")
    rows = [[*question, *answer] for question, answer in zip(asked, found)]
    fixture.write("fspid-formats", "fcl/asked-jfuzzylogic.csv", "statements,rules,x,y,z,v", rows)
