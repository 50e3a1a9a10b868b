# ctest-label: no-sanitizer
"""Command line, input, output files and exit codes of drogue-options."""

import csv
import os
import re
import resource
import signal
import subprocess
import time
from pathlib import Path

import gas_program
import options_program
from options_program import FAST, HEADER, batch, row


class CommandLine(options_program.OptionsTest):
    def test_prints_version_help_and_shipped_batches(self):
        self.assertRegex(self.expect(0, "--version").stdout, r"^drogue-options \d+\.\d+\.\d+\n")
        self.assertIn("surface", self.expect(0, "--help").stdout)
        for word in ("--out", "--tolerance", "--mesh", "--greeks", "--boundary", "--method", "--result", "--backend"):
            self.assertIn(word, self.expect(0, "price", "--help").stdout)
        self.assertIn("--strikes", self.expect(0, "surface", "--help").stdout)
        names = sorted(path.stem for path in options_program.BATCHES.glob("*.csv"))
        self.assertEqual(names, [line.split()[0] for line in self.expect(0, "--list-batches").stdout.splitlines()])
        self.assertEqual([], self.names())

    def test_terminal_shows_the_share_of_the_rows_that_are_priced(self):
        self.write(batch([row(i) for i in range(320)]))
        shown = self.terminal("price", "batch.csv", "--backend", "serial", "--chunk", "16", *FAST)
        first = re.search(r"(\d+) rows \((\d+) %\)", shown)
        self.assertEqual(("16", "5"), first.groups(), shown)

    def test_states_the_largest_error_beside_the_speed(self):
        strikes = {"a": 1.0, "b": 50.0}
        self.write(batch([row(name, strike=strike, spot=strike, style="american") for name, strike in strikes.items()]))
        text = self.expect(0, "price", "batch.csv", "--backend", "serial", "--chunk", "1", "--result", "r.json").stdout
        largest = max(float(priced["error"]) / strikes[priced["id"]] for priced in self.prices())
        self.assertAlmostEqual(1.0, self.document("r.json")["errors"]["stated"] / largest, places=12)
        self.assertRegex(text, rf"\n  \S+ options per second of \S+ s of pricing; largest stated error {largest:.2g} of the strike\n")
        # The scheme of [Shi] states none.
        text = self.expect(0, "price", "batch.csv", "--backend", "serial", "--method", "seed", "--mesh", "64", "--steps", "16", "--result", "r.json").stdout
        self.assertRegex(text, r" s of pricing\n")
        self.assertEqual({}, self.document("r.json")["errors"])

    def test_rejects_invalid_command_lines(self):
        cases = {
            (): "no command",
            ("prize", "example"): "prize",
            ("price",): "BATCH",
            ("price", "exampel"): 'did you mean "example"?',
            ("price", "example", "--tolerence", "1"): "--tolerance",
            ("price", "example", "--tolerance", "0"): "--tolerance",
            ("price", "example", "--tolerance", "nan"): "--tolerance",
            ("price", "example", "--tolerance", "2"): "--tolerance",
            ("price", "example", "--tolerance", ""): "--tolerance is empty",
            ("price", "example", "--mesh", "128"): "--steps",
            ("price", "example", "--mesh", "128.5", "--steps", "32"): "whole number",
            ("price", "example", "--mesh", "-4", "--steps", "32"): "--mesh",
            ("price", "example", "--mesh", "33", "--steps", "32"): "--mesh = '33' is not an even whole number in 32 .. 4096",
            ("price", "example", "--mesh", "0", "--steps", "32"): "in 32 .. 4096",
            ("price", "example", "--mesh", "4098", "--steps", "32"): "in 32 .. 4096",
            ("price", "example", "--mesh", "128", "--steps", "6"): "--steps = '6' is not an even whole number in 8 .. 16384",
            ("price", "example", "--mesh", "128", "--steps", "16386"): "in 8 .. 16384",
            ("price", "example", "--mesh", "128", "--steps", "32", "--tolerance", "1e-3"): "--tolerance",
            ("price", "example", "--method", "tree"): "--method",
            ("price", "example", "--method", "cos", "--mesh", "128", "--steps", "32"): "no mesh",
            ("price", "example", "--method", "cos", "--boundary", "b.csv"): "--boundary",
            ("price", "example", "--method", "seed"): "--mesh",
            ("price", "example", "--backend", "gpu"): "--backend",
            ("price", "example", "--chunk", "0"): "--chunk",
            ("surface", "example"): "--strikes",
            ("surface", "example", "--strikes", "1:2", "--maturities", "1"): "first:last:count",
            ("surface", "example", "--strikes", "0", "--maturities", "1"): "--strikes",
            ("surface", "example", "--strikes", "1", "--maturities", "1,,2"): "--maturities",
            ("surface", "example", "--strikes", "100 110", "--maturities", "1"): "--strikes = '100 110'",
            ("surface", "example", "--strikes", "60:140:1", "--maturities", "1"): "--strikes = '60:140:1' has two ends but a count of 1",
            ("surface", "example", "--strikes", ",", "--maturities", "1"): "--strikes = ''",
            ("price", "-"): "it cannot come from standard input; give the name of a file",
            ("price", "example", "--out", "-"): "standard output is /dev/stdout",
            ("price", "example", "--result", "-"): "standard output is /dev/stdout",
            ("prise", "example"): "unknown command 'prise'; did you mean \"price\"?",
            ("price", "example", "extra"): "extra",
            ("price", "example", "--kokkos-num-threads=0"): "0",
        }
        for words, message in cases.items():
            with self.subTest(words):
                self.assertIn(message, self.expect(2, *(words or ("--kokkos-tune-internals",))).stderr)
        self.assertEqual([], self.names())

    def test_rejects_an_unwritable_result_before_pricing(self):
        file = self.write(batch([row(k, style="american", spot=0.5 + 1e-4 * k) for k in range(100000)]))
        message = self.expect(6, "price", file, "--backend", "serial", "--result", "missing/r.json").stderr
        self.assertIn("missing/r.json", message)
        self.assertEqual([file.name], self.names())

    def test_reports_a_missing_backend(self):
        if "cuda" in gas_program.backends():
            self.skipTest("a CUDA build has the backend")
        self.assertRegex(self.expect(77, "price", "example", "--backend", "cuda", "--result", "r.json").stderr, "cuda.*preset")
        written = self.document("r.json")
        self.assertEqual(("no-backend", 77), (written["status"], written["exit_code"]))
        self.assertEqual(["r.json"], self.names())

    def test_rejects_input_that_is_no_regular_file(self):
        (self.folder / "folder").mkdir()
        os.mkfifo(self.folder / "pipe")
        for name, message in (("folder", "directory"), ("pipe", "regular"), ("/dev/null", "regular"), ("none.csv", "no file")):
            with self.subTest(name):
                self.assertIn(message, self.expect(2, "price", name).stderr)
        self.assertEqual(["folder", "pipe"], self.names())

    def test_rejects_outputs_that_overwrite_another_file(self):
        file = self.write(batch([row("a")]))
        (self.folder / "link.csv").symlink_to(file)
        os.link(file, self.folder / "hard.csv")
        os.mkfifo(self.folder / "pipe")
        os.link(self.folder / "pipe", self.folder / "pipe2")
        for words in (["--out", file], ["--out", "./batch.csv"], ["--out", "link.csv"], ["--out", "hard.csv"],
                      ["--result", file], ["--boundary", file], ["--out", "x", "--result", "x"], ["--out", "pipe", "--boundary", "pipe2"],
                      ["--boundary", "y", "--result", "y"], ["--out", self.folder]):
            with self.subTest(words):
                self.assertIn("name another output", self.expect(2, "price", file, *words).stderr)
        self.assertEqual(batch([row("a")]), file.read_text())
        self.assertEqual(["batch.csv", "hard.csv", "link.csv", "pipe", "pipe2"], self.names())


class Prices(options_program.OptionsTest):
    def test_all_spellings_of_a_batch_give_the_same_prices(self):
        """Spellings: order of columns, defaults, quotes, line ends, a byte-order mark."""
        self.price(0, batch([row("a"), row("b", style="american")]), *FAST)
        expected = self.prices()
        plain = HEADER + "\n" + row("a") + "\n" + row("b", style="american")
        order = list(reversed(range(13)))
        reordered = "\n".join(",".join(line.split(",")[k] for k in order) for line in plain.splitlines())
        quoted = "\n".join(",".join(f' "{field}"\t' for field in line.split(",")) for line in plain.splitlines())
        for content in (plain, reordered, quoted, plain.replace("\n", "\r\n") + "\r\n", "\ufeff" + plain,
                        "\n \n" + plain.replace("\n", "\n\n") + "\n\t\n", plain.replace(",0,1,", ",,1,").replace("put", "")):
            with self.subTest(content[:30]):
                self.price(0, content, *FAST)
                self.assertEqual(expected, self.prices())

    def test_keeps_ids_and_numbers_rows_without_one(self):
        for given in ('comma, "quote"', "0007", " inner blank", "ünï"):
            quoted = '"' + given.replace('"', '""') + '"'
            self.price(0, batch([row(quoted)]), *FAST)
            self.assertEqual(given, self.prices()[0]["id"])
        without = batch([row("")] * 3)
        self.price(0, without, *FAST)
        self.assertEqual(["1", "2", "3"], [price["id"] for price in self.prices()])
        self.price(0, "\n".join(line.split(",", 1)[1] for line in without.splitlines()), *FAST)
        self.assertEqual(["1", "2", "3"], [price["id"] for price in self.prices()])

    def test_writes_no_prices_for_a_batch_without_rows(self):
        self.price(0, HEADER + "\n")
        self.assertEqual([], self.prices())

    def test_accepts_the_limits_of_mesh_and_steps(self):
        for mesh, steps in ((32, 8), (4096, 8), (32, 16384)):
            self.price(0, batch([row("a")]), "--mesh", mesh, "--steps", steps)
            self.assertEqual((str(mesh), str(steps)), tuple(self.prices()[0][name] for name in ("mesh", "steps")))

    def test_writes_vega_and_rho_behind_the_other_columns(self):
        content = batch([row("a", style="american"), row("b", beta=9), row("c", style="american", spot=0.2),
                         row("d", variance=0), row("e", type="call", style="american", dividend=0.05)])
        for method in ((), FAST):
            self.price(3, content, "--greeks", *method)
            lines = (self.folder / "prices.csv").read_text().splitlines()
            self.assertEqual(",".join([*options_program.COLUMNS, *options_program.GREEKS]), lines[0])
            self.assertEqual({len(options_program.COLUMNS) + 2}, {len(line) for line in csv.reader(lines)})
            a, b, c, d, e = self.prices()
            self.assertGreater(float(a["vega"]), 0.05)
            self.assertLess(float(a["rho"]), -0.05)
            self.assertEqual(("", ""), (b["vega"], b["rho"]))
            self.assertEqual(["-1", "0", "0", "0", "0"], [c[name] for name in ("delta", "gamma", "theta", "vega", "rho")])
            self.assertEqual("0", d["vega"])
            self.assertGreater(float(e["rho"]), 0.05)
        self.price(3, content)
        self.assertEqual(options_program.COLUMNS, (self.folder / "prices.csv").read_text().splitlines()[0].split(","))

    def test_blanks_around_strikes_are_ignored(self):
        head, line = "id,style,spot,rate,lambda,alpha,beta,delta", "a,european,1,0.05,1,8.15,-2.5,0.767"
        sets = self.write(f"{head}\n{line}\n", "sets.csv")
        written = set()
        for strikes, maturities in (("0.9,1.1", "0.5:1:2"), (" 0.9, 1.1 ", "0.5 : 1 : 2"), ("0.9,1.1,", "0.5,1, ")):
            self.expect(0, "surface", sets, "--strikes", strikes, "--maturities", maturities, "--quiet", "--mesh", "64", "--steps", "16")
            written.add((self.folder / "surface.csv").read_bytes())
        self.assertEqual(1, len(written))
        self.assertIn("--strikes = '", self.expect(2, "surface", sets, "--strikes", "0.9,,1", "--maturities", "1").stderr)

    def test_converts_other_parameters_to_a_batch(self):
        """A price does not depend on the unit of time, and a batch that is converted is one that can be priced."""
        given = "id,style,spot,strike,rate,maturity,alpha,beta,delta\na,european,1,1.1,0.05,0.5,40,-8,0.02\n"
        price = {}
        for unit in ("year", "period"):
            self.expect(0, "convert", "nig", self.write(given, "nig.csv"), "--periods-per-year", "250", "--time-unit", unit,
                        "--out", f"{unit}.csv")
            self.expect(0, "price", f"{unit}.csv", "--quiet", *FAST)
            price[unit] = float(self.prices()[0]["price"])
        self.assertAlmostEqual(price["year"], price["period"], delta=1e-12)
        printed = self.expect(0, "convert", "variance-gamma", "--parameters", "sigma=0.2,nu=0.5,theta=0").stdout
        self.assertEqual("lambda,alpha,beta,delta,variance\n2,10,0,0,0\n", printed)
        for words, code, sentence in ((("nig",), 2, "needs a CSV file or --parameters"),
                                      (("nigg", "nig.csv"), 2, "nigg"),
                                      (("nig", "no.csv"), 2, "no.csv"),
                                      (("variance-gamma", "nig.csv"), 3, 'unknown column "alpha"'),
                                      (("nig", "nig.csv", "--periods-per-year", "0"), 2, "--periods-per-year")):
            self.assertIn(sentence, self.expect(code, "convert", *words).stderr)

    def test_writes_greeks_on_request(self):
        content = batch([row("a", style="american")])
        self.price(0, content)
        self.assertEqual(("", "", ""), tuple(self.prices()[0][name] for name in ("delta", "gamma", "theta")))
        self.price(0, content, "--greeks")
        greeks = {name: float(self.prices()[0][name]) for name in ("delta", "gamma", "theta")}
        self.price(0, content, "--greeks", *FAST)
        for name, value in greeks.items():
            self.assertAlmostEqual(value, float(self.prices()[0][name]), delta=2e-3, msg=name)

    def test_methods_agree_within_their_errors(self):
        self.expect(0, "price", "example", "--quiet", "--out", "pide.csv")
        self.expect(0, "price", "example", "--quiet", "--out", "cos.csv", *FAST)
        for one, other in zip(self.prices("pide.csv"), self.prices("cos.csv"), strict=True):
            tolerance = float(one["error"]) + float(other["error"])
            self.assertAlmostEqual(float(one["price"]), float(other["price"]), delta=tolerance, msg=one["id"])

    def test_baseline_gives_a_price_without_error(self):
        self.price(0, batch([row("a", style="american")]), "--method", "seed", "--mesh", "128", "--steps", "128")
        self.assertAlmostEqual(0.239004005, float(self.prices()[0]["price"]), delta=4.4e-4)
        self.assertEqual("", self.prices()[0]["error"])
        other = f"{HEADER},model\n{row('a')},gh\nb,european,put,1,1,0.1,0,1,,,,,0.4,black-scholes\n"
        self.price(3, other, "--method", "seed", "--mesh", "128", "--steps", "32")
        self.assertEqual(["ok", "invalid"], [price["status"] for price in self.prices()])

    def test_writes_the_exercise_boundary(self):
        lines = [row("put", style="american"), row("europe"), row("wait", style="american", type="call")]
        self.price(0, batch(lines), "--boundary", "b.csv")
        points = self.table("b.csv")
        self.assertEqual(["id", "time", "spot", "maturity"], list(points[0]))
        self.assertEqual({1.0}, {float(point["maturity"]) for point in points})
        self.assertEqual({"put"}, {point["id"] for point in points})
        times = [float(point["time"]) for point in points]
        self.assertEqual((0.0, True), (times[0], times == sorted(times) and times[-1] < 1.0))
        spots = [float(point["spot"]) for point in points]
        self.assertTrue(all(0.3 < spot < 1.0 for spot in spots))
        self.assertLess(spots[0], spots[-1])

    def test_boundary_at_time_zero_equals_that_of_the_price(self):
        self.expect(0, "price", "example", "--quiet", "--backend", "serial", "--boundary", "b.csv")
        now = {point["id"]: point["spot"] for point in self.table("b.csv") if point["time"] == "0"}
        self.assertEqual({price["id"]: price["exercise_boundary"] for price in self.prices() if price["exercise_boundary"]}, now)

    def test_surface_has_all_strikes_and_maturities(self):
        header = ",".join(name for name in HEADER.split(",") if name not in ("strike", "maturity"))
        sets = f"{header}\nset,european,put,1.0,0.1,0,1,8.15,-2.5,0.767,0.4\nbad,european,put,1.0,0.1,0,1,8.15,9,0.767,0.4\n"
        self.expect(3, "surface", self.write(sets), "--strikes", "0.8:1.2:5", "--maturities", "0.25,1", "--quiet", *FAST)
        written = self.table("surface.csv")
        self.assertEqual(11, len(written))
        self.assertEqual(["0.8", "0.9", "1", "1.1", "1.2"], [f"{float(point['strike']):g}" for point in written[:5]])
        self.assertEqual({"0.25", "1"}, {point["maturity"] for point in written[:10]})
        self.assertEqual(("bad", "invalid", ""), (written[10]["id"], written[10]["status"], written[10]["strike"]))
        self.price(0, batch([row("one", strike=1.2)]), *FAST)
        self.assertEqual(self.prices()[0]["price"], written[9]["price"])

    def test_surface_agrees_with_single_contracts(self):
        """Strikes of a surface share solves."""
        header = ",".join(name for name in HEADER.split(",") if name not in ("strike", "maturity"))
        sets = self.write(f"{header}\nset,american,put,1.0,0.1,0,1,8.15,-2.5,0.767,0.4\n", "sets.csv")
        words = ("--maturities", "0.25,1", "--mesh", "128", "--steps", "32", "--greeks", "--backend", "serial", "--quiet")
        written = {}
        for name, strikes in (("all", "0.5:2:7"), ("one", "1.25"), ("pieces", "0.5:2:7")):
            chunk = ("--chunk", "3") if name == "pieces" else ()
            self.expect(0, "surface", sets, "--strikes", strikes, *words, *chunk, "--out", f"{name}.csv", "--result", "r.json")
            written[name] = self.table(f"{name}.csv")
        self.assertEqual({"rows": 14, "ok": 14, "coarse": 0, "invalid": 0, "failed": 0},
                         self.document("r.json")["counts"])
        self.assertEqual(written["all"], written["pieces"])
        self.assertEqual(written["one"], [written["all"][3], written["all"][10]])
        contracts = [row(k, style="american", strike=point["strike"], maturity=point["maturity"]) for k, point in enumerate(written["all"])]
        self.price(0, batch(contracts), "--mesh", "128", "--steps", "32", "--greeks")
        for point, own in zip(written["all"], self.prices(), strict=True):
            room = float(point["error"]) + float(own["error"])
            self.assertAlmostEqual(float(point["price"]), float(own["price"]), delta=room, msg=point["strike"])
            self.assertAlmostEqual(float(point["delta"]), float(own["delta"]), delta=5e-3, msg=point["strike"])
        boundary = [float(point["exercise_boundary"]) / float(point["strike"]) for point in written["all"][:7]]
        self.assertLess(max(boundary) - min(boundary), 1e-12)

    def test_result_describes_the_run(self):
        content = batch([row("a"), row("b", beta=9), row("c", style="american")])
        message = self.price(3, content, "--result", "r.json").stderr.strip()
        written = self.document("r.json")
        self.assertEqual(("drogue.result/1", "drogue-options", "batch", "serial", "invalid", 3, message),
                         tuple(written[key] for key in ("schema", "program", "scene", "backend", "status", "exit_code", "message")))
        self.assertEqual({"rows": 3, "ok": 2, "coarse": 0, "invalid": 1, "failed": 0}, written["counts"])
        self.assertGreater(written["timing"]["compute_s"], 0.0)
        self.assertGreater(written["ledger"]["kernel_launches"], 0)

    def test_reports_failed_and_invalid_rows(self):
        content = batch([row("a"), row("b", beta=9), row("c", rate=-400, maturity=2)])
        self.assertEqual("drogue-options: 1 of 3 rows failed, the first in line 4, and 1 of 3 rows invalid, the first in line 3; "
                         "every other row is priced in 'prices.csv'", self.price(4, content).stderr.strip())
        self.assertEqual(["ok", "invalid", "failed"], [price["status"] for price in self.prices()])

    def test_says_where_no_row_is_left(self):
        message = self.price(3, batch([row("a", beta=9), row("b", beta=9)])).stderr.strip()
        self.assertTrue(message.endswith("(2 of 2 rows invalid; none is priced in 'prices.csv')"), message)

    def test_refuses_rows_that_are_not_utf8(self):
        """Their bytes would make the output no UTF-8 either."""
        file = self.folder / "latin.csv"
        file.write_bytes(batch([row("caf\u00e9"), row("b")]).encode("latin-1"))
        message = self.expect(3, "price", "latin.csv", "--quiet", *FAST).stderr
        self.assertIn("latin.csv:2: the line is not UTF-8; save the file as UTF-8 (1 of 2 rows invalid", message)
        self.assertEqual(["invalid", "ok"], [price["status"] for price in self.prices()])
        self.assertEqual(["", "b"], [price["id"] for price in self.prices()])
        self.price(0, batch([row("caf\u00e9"), row("b")]))
        self.assertEqual("caf\u00e9", self.prices()[0]["id"])

    def test_message_of_a_failed_row_names_a_remedy(self):
        """The remedy is an option of the run, and the row is priced with it."""
        header = HEADER + ",model,intensity,jump_mean,jump_deviation"
        gh = {"dividend": row("dividend", dividend="1e308"), "rate": row("rate", rate="1e308")}
        lines = [line + ",,,," for line in gh.values()]
        lines += [f"{k},european,put,1,1,0.05,0,1,,,,,0.04,merton,{k},-0.1,0.2" for k in ("1e4", "1e12")]
        content = header + "\n" + "\n".join(lines) + "\n"
        grid = ("--mesh", "128", "--steps", "32")
        for words in (grid, ()):
            self.price(4, content, *words)
            written = {price["id"]: price["message"] for price in self.prices()}
            for name in ("dividend", "rate"):
                self.assertIn("exceed the range of double", written[name])
            self.assertIn("too many jumps until maturity for any number of steps", written["1e12"])
            self.assertFalse([name for name in written if name != "1e4" and "--steps" in written[name]])
            advice = "more --steps or another --mesh or" if words else "--mesh and --steps together instead of it or"
            self.assertIn(advice, written["1e4"])
            self.assertEqual(not words, "--tolerance" in written["1e4"])
            self.assertTrue(all("--method cos may price it" in message for message in written.values()))
        self.price(4, content, "--mesh", "128", "--steps", "16384")
        self.assertEqual(["failed", "failed", "ok", "failed"], [price["status"] for price in self.prices()])
        self.price(4, content, *FAST)
        self.assertEqual(["ok", "failed", "ok", "ok"], [price["status"] for price in self.prices()])

    def test_only_a_tolerance_makes_a_row_coarse(self):
        """A given grid has no tolerance that it could miss."""
        content = batch([row("a", delta=0, variance=0, maturity=1, **{"lambda": 0.1})])
        self.price(0, content, "--tolerance", "1e-9")
        self.assertEqual("coarse", self.prices()[0]["status"])
        self.price(0, content, "--mesh", "64", "--steps", "16")
        self.assertEqual("ok", self.prices()[0]["status"])
        self.assertGreater(float(self.prices()[0]["error"]), 1e-4)

    def test_summary_counts_rows_by_status(self):
        run = self.expect(0, "price", "example", *FAST, "--tolerance", "1e-3")
        self.assertRegex(run.stdout, r"^example on \w+: 11 rows in \S+ s: 11 ok, 0 coarse, 0 invalid, 0 failed\n")

    def test_summary_of_a_surface_counts_parameter_sets_and_prices(self):
        sets = "spot,rate,lambda,alpha,beta,delta,style\n" + "".join(f"1,0.1,1,8,{beta},0.7,european\n" for beta in (-2, 9, -3))
        run = self.expect(3, "surface", self.write(sets), "--strikes", "0.9,1,1.1", "--maturities", "1,2", *FAST)
        self.assertRegex(run.stdout, r"^batch on \w+: 3 parameter sets in \S+ s: 1 invalid; 12 prices: 12 ok, 0 coarse, 0 invalid, 0 failed\n")
        self.assertIn("(1 of 3 parameter sets invalid; all others are priced in 'surface.csv')", run.stderr)

    def test_invalidates_only_the_surface_points_of_an_invalid_strike(self):
        """The other points have the same bits for any such strike and any size of chunks."""
        head = "id,style,spot,rate,lambda,alpha,beta,delta,variance"
        good = ["low,american,100,0.05,-0.5,15,-5,0.5,0.04", "high,european,1e25,0.05,-0.5,15,-5,0.5,0.04"]
        sets = self.write("\n".join([head, *good, "bad,european,100,0.05,-0.5,15,19,0.5,0.04"]))
        written = {}
        for strikes, chunk in (("100,1e25", ()), ("100,1e23", ()), ("1e101,100,1e25", ()), ("1e101,100,1e25", ("--chunk", "1")),
                               ("100", ()), ("1e25", ())):
            run = self.expect(3, "surface", sets, "--strikes", strikes, "--maturities", "0.5,1", "--mesh", "64", "--steps", "16",
                              "--result", "r.json", "--backend", "serial", *chunk)
            written[strikes, chunk] = self.table("surface.csv")
            points = 4 * len(strikes.split(","))
            wrong = points - (2 if strikes in ("100", "1e25") else 4)
            self.assertRegex(run.stdout, rf": 3 parameter sets in \S+ s: 1 invalid; {points} prices: \d+ ok, \d+ coarse, {wrong} invalid, 0 failed")
            self.assertIn(f"batch.csv:{3 if strikes == '100' else 2}: s", run.stderr)
            self.assertIn(f"(1 of 3 parameter sets and {wrong} of {points} prices invalid; all others are priced", run.stderr)
            counts = self.document("r.json")["counts"]
            self.assertEqual((points + 1, wrong + 1, points - wrong), (counts["rows"], counts["invalid"], counts["ok"] + counts["coarse"]))
        mixed = written["100,1e25", ()]
        self.assertEqual(["low"] * 4 + ["high"] * 4 + ["bad"], [point["id"] for point in mixed])
        self.assertEqual(["100", "1e+25"] * 4, [point["strike"] for point in mixed[:8]])
        self.assertEqual(["0.5", "0.5", "1", "1"] * 2, [point["maturity"] for point in mixed[:8]])
        self.assertEqual({("spot/strike must lie between 1e-20 and 1e20", "", "")},
                         {(p["message"], p["price"], p["steps"]) for p in mixed[:8] if p["status"] == "invalid"})
        self.assertEqual(("|beta| < alpha", ""), (mixed[8]["message"][:14], mixed[8]["strike"]))
        self.assertIn("strike must lie between 1e-100 and 1e100", {point["message"] for point in written["1e101,100,1e25", ()]})
        self.assertEqual(written["1e101,100,1e25", ()], written["1e101,100,1e25", ("--chunk", "1")])
        priced = {strikes: [point for point in points if point["price"]] for (strikes, _), points in written.items()}
        self.assertEqual(4, len(priced["100,1e25"]))
        self.assertEqual(priced["100,1e25"], priced["1e101,100,1e25"])
        self.assertEqual(priced["100,1e25"], priced["100"] + priced["1e25"])
        self.assertEqual(priced["100"], priced["100,1e23"][:2])


class SameBits(options_program.OptionsTest):
    BATCH = batch([row(k, style="american" if k % 2 else "european", spot=0.7 + 0.02 * k, maturity=0.1 + 0.05 * k,
                       beta=9 if k % 11 == 5 else -2.5) for k in range(40)])

    def test_prices_are_independent_of_chunks(self):
        written = set()
        for chunk in (["--chunk", "1"], ["--chunk", "7"], ["--chunk", "1000"], []):
            self.price(3, self.BATCH, *chunk)
            written.add((self.folder / "prices.csv").read_bytes())
        self.assertEqual(1, len(written))

    @gas_program.needs_openmp
    def test_prices_are_independent_of_the_backend(self):
        for method in ([], [*FAST, "--tolerance", "1e-3"]):
            written = set()
            for backend in ("serial", "openmp"):
                self.expect(3, "price", self.write(self.BATCH), "--quiet", *method, "--backend", backend)
                written.add((self.folder / "prices.csv").read_bytes())
            self.assertEqual(1, len(written), method)


class Files(options_program.OptionsTest):
    def test_keeps_the_former_file_on_a_full_disk(self):
        """A limit of the file size simulates a full disk."""
        file = self.write(batch([row(k) for k in range(300)]))
        self.write("former", "prices.csv")
        for limit in (0, 100, 5000):
            with self.subTest(limit):
                run = self.run_with("price", file, "--backend", "serial", "--quiet", *FAST, preexec_fn=lambda: resource.setrlimit(
                    resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY)))
                self.assertEqual((6, 1), (run.returncode, len(run.stderr.splitlines())), run.stderr)
                self.assertRegex(run.stderr, "cannot write 'prices.csv'.*File too large")
                self.assertEqual(["batch.csv", "prices.csv"], self.names())
                self.assertEqual("former", (self.folder / "prices.csv").read_text())

    def test_writes_to_devices_and_reports_a_full_one(self):
        file = self.write(batch([row("a", style="american")]))
        for words in (("--out", "/dev/full"), ("--boundary", "/dev/full"), ("--result", "/dev/full")):
            run = self.expect(6, "price", file, "--quiet", *words)
            self.assertEqual("drogue-options: cannot write '/dev/full': No space left on device\n", run.stderr)
        given = {size: self.write("alpha,beta,delta\n" + size * "40,-8,0.02\n", f"{size}.csv") for size in (1, 10000)}
        for words in (("--list-batches",), ("convert", "nig", given[1]), ("convert", "nig", given[10000])):
            with self.subTest(words), open("/dev/full", "w", encoding="utf-8") as full:
                run = subprocess.run([options_program.PROGRAM, *words], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
                self.assertEqual((6, "drogue-options: cannot write to standard output\n"), (run.returncode, run.stderr))
        self.expect(0, "price", file, "--out", "/dev/null", "--boundary", "/dev/null", "--result", "/dev/null")
        head, line = "id,spot,rate,lambda,alpha,beta,delta,variance", "a,1,0.05,1,8.15,-2.5,0.767,0.04"
        sets = self.write(f"{head}\n{line}\n", "sets.csv")
        self.expect(6, "surface", sets, "--strikes", "1", "--maturities", "1", "--out", "/dev/full")

    def test_appends_to_standard_output_without_a_summary(self):
        """Uses a symbolic link of its own, so that a failure does not replace that of the system."""
        file = self.write(batch([row("a")]))
        (self.folder / "out").symlink_to("/proc/self/fd/1")
        self.expect(0, "price", file, *FAST)
        expected = (self.folder / "prices.csv").read_text()
        self.assertEqual(expected, self.expect(0, "price", file, *FAST, "--out", "out").stdout)
        with (self.folder / "all").open("w", encoding="utf-8") as stream:
            print("title", file=stream, flush=True)
            subprocess.run([options_program.PROGRAM, "price", file, *FAST, "--out", "out"], cwd=self.folder, check=True,
                           stdout=stream, env=gas_program.ENVIRONMENT)
        self.assertEqual("title\n" + expected, (self.folder / "all").read_text())
        self.assertTrue((self.folder / "out").is_symlink())

    def test_reports_a_pipe_whose_reader_closes(self):
        """The prices do not fit into the buffer of the pipe, so that the program is still running."""
        file = self.write(batch([row(f"a{k:0100}") for k in range(2000)]))
        os.mkfifo(self.folder / "pipe")
        reader = os.open(self.folder / "pipe", os.O_RDONLY | os.O_NONBLOCK)
        process = subprocess.Popen([options_program.PROGRAM, "price", file, "--quiet", "--out", "pipe", *FAST],
                                   cwd=self.folder, stderr=subprocess.PIPE, text=True, env=gas_program.ENVIRONMENT)
        self.addCleanup(process.kill)
        for _ in range(200):
            if any(name.resolve() == (self.folder / "pipe").resolve() for name in Path(f"/proc/{process.pid}/fd").iterdir()):
                break
            time.sleep(0.02)
        os.close(reader)
        self.assertEqual("drogue-options: cannot write 'pipe': Broken pipe\n", process.communicate(timeout=60)[1])
        self.assertEqual(6, process.returncode)

    def test_reports_a_missing_output_folder(self):
        self.assertIn("no/prices.csv", self.price(6, batch([row("a")]), "--out", "no/prices.csv").stderr)

    def start_long_run(self, *words, method=FAST):
        """Starts a run of minutes and returns its process once it is pricing."""
        file = self.write(batch([row(k, style="american", spot=0.5 + 1e-4 * k) for k in range(3000)]))
        command = [options_program.PROGRAM, "price", file, "--backend", "serial", *method, "--result", "r.json", *words]
        process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   env=gas_program.ENVIRONMENT)
        for _ in range(200):
            if any(name.endswith(".tmp") for name in self.names()):
                return process
            time.sleep(0.05)
        process.kill()
        self.fail("the run has not begun")

    def test_leaves_no_output_of_a_killed_run(self):
        process = self.start_long_run()
        process.kill()
        process.communicate()
        self.assertFalse((self.folder / "prices.csv").exists())

    def test_reports_partial_output_to_a_device_after_an_interrupt(self):
        process = self.start_long_run("--out", "/dev/null", "--boundary", "b.csv", "--mesh", "512", "--steps", "512", method=())
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual((130, ["batch.csv", "r.json"]), (process.returncode, self.names()))
        self.assertIn("not all is written to '/dev/null'", self.document("r.json")["message"])

    def test_leaves_only_the_result_of_an_interrupted_run(self):
        process = self.start_long_run()
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        message = process.communicate(timeout=60)[1]
        self.assertEqual(130, process.returncode)
        self.assertIn(b"drogue-options: interrupted by a signal; nothing is written to ", message)
        self.assertEqual(["batch.csv", "r.json"], self.names())
        self.assertEqual("interrupted", self.document("r.json")["status"])

    def test_memory_is_independent_of_the_batch_size(self):
        peaks = []
        for rows in (1000, 10000):
            self.price(0, batch([row(k) for k in range(rows)]), *FAST, "--chunk", "500", "--result", "r.json")
            peaks.append(self.document("r.json")["peak_bytes"]["host"])
        self.assertLess(peaks[1], peaks[0] + 2 * 2**20)

    def test_reports_a_line_of_a_gigabyte_in_little_memory(self):
        """The line is a hole in a sparse file."""
        file = self.write(batch([row("a")]))
        with file.open("r+b") as stream:
            stream.seek(2**30)
            stream.write(f"\n{row('b')}\n".encode())
        self.expect(3, "price", file, "--backend", "serial", "--quiet", *FAST, "--result", "r.json")
        self.assertEqual(["ok", "invalid", "ok"], [written["status"] for written in self.prices()])
        self.assertLess(self.document("r.json")["peak_bytes"]["host"], 200 * 2**20)
