"""Invalid rows of a batch are reported as `invalid`, all others are priced; an invalid file ends with exit code 3."""

import bad_batches
import options_program
from options_program import FAST, HEADER, batch, row


class BadBatches(options_program.OptionsTest):
    def test_rejects_invalid_rows_and_prices_the_others(self):
        """All invalid rows in one file, with a valid row before and after each."""
        self.assertGreaterEqual(len(bad_batches.BAD_ROWS) + len(bad_batches.BAD_LINES), 40)
        cases = [(row(f"bad{k}", **values), words) for k, (values, words) in enumerate(bad_batches.BAD_ROWS)]
        cases += bad_batches.BAD_LINES
        lines = [row("first")]
        for k, (line, _) in enumerate(cases):
            lines += [line, row(f"good{k}")]
        message = self.price(3, batch(lines), *FAST).stderr
        self.assertTrue(message.startswith(f"{self.folder / 'batch.csv'}:3: |beta+1| < alpha"), message)
        self.assertIn(f"{len(cases)} of {len(lines)} rows invalid", message)
        prices = self.prices()
        self.assertEqual(len(lines), len(prices))
        for k, (line, words) in enumerate(cases):
            with self.subTest(line=line[:60]):
                reported = prices[2 * k + 1]
                self.assertEqual(("invalid", ""), (reported["status"], reported["price"]))
                for word in words:
                    self.assertIn(word, reported["message"])
        for reported in prices[::2]:
            self.assertEqual(("ok", prices[0]["price"]), (reported["status"], reported["price"]))

    def test_unreadable_lines_report_their_id(self):
        """Each reports its own id if it has one, and no other row is rejected."""
        broken = bad_batches.BROKEN_LINES
        lines = [row(k) for k in range(2 * len(broken))]
        for k, (line, _) in enumerate(broken):
            lines.insert(3 * k + 1, line)
        written = set()
        for chunk in ("1", "4", "1000"):
            self.price(3, batch(lines), *FAST, "--chunk", chunk)
            written.add((self.folder / "prices.csv").read_bytes())
        self.assertEqual(1, len(written))
        prices = self.prices()
        for k, (line, identity) in enumerate(broken):
            with self.subTest(line=line[:40]):
                reported = prices.pop(2 * k + 1)
                self.assertEqual((identity, "invalid"), (reported["id"], reported["status"]))
                self.assertEqual(not identity, reported["message"].startswith(f"line {3 * k + 3}: "), reported["message"])
        self.assertEqual([(str(k), "ok") for k in range(2 * len(broken))], [(reported["id"], reported["status"]) for reported in prices])

    def test_unreadable_lines_without_ids_report_their_row(self):
        """Without ids a row is identified by its number."""
        def without(line):
            return line.split(",", 1)[1]
        lines = [without(row("x")), "1,2", without(row("x")), '"', without(row("x"))]
        self.price(3, "\n".join([without(HEADER), *lines]), *FAST)
        self.assertEqual([("1", "ok"), ("2", "invalid"), ("3", "ok"), ("4", "invalid"), ("5", "ok")],
                         [(reported["id"], reported["status"]) for reported in self.prices()])

    def test_finds_ids_in_a_later_column(self):
        names = HEADER.split(",")
        head = ",".join([*names[1:3], "id", *names[3:]])

        def moved(line):
            fields = line.split(",")
            return ",".join([*fields[1:3], fields[0], *fields[3:]])
        lines = [moved(row("a")), "european,put", moved(row("b")) + ",9", 'european,"put', 'european,put,c,"1', moved(row("d"))]
        self.price(3, "\n".join([head, *lines]), *FAST)
        self.assertEqual(["a", "", "b", "", "c", "d"], [reported["id"] for reported in self.prices()])

    def test_rejects_invalid_files(self):
        self.assertGreaterEqual(len(bad_batches.BAD_FILES), 20)
        for content, line, words in bad_batches.BAD_FILES:
            with self.subTest(content=content[:60]):
                message = self.price(3, content, *FAST).stderr
                self.assertTrue(message.startswith(f"{self.folder / 'batch.csv'}:{line}: "), message)
                for word in words:
                    self.assertIn(word, message)
                self.assertEqual(["batch.csv"], self.names())

    def test_reads_what_spreadsheets_add(self):
        """The line of the separator, rows of commas, and empty fields behind the last column."""
        self.price(0, batch([row("a"), row("b")]), *FAST)
        expected = self.prices()
        empty = "," * HEADER.count(",")
        self.price(0, "sep=,\r\n" + "\r\n".join([HEADER, row("a") + ",,", empty, row("b"), empty + ",", empty]) + "\r\n", *FAST)
        self.assertEqual(expected, self.prices())
        lines = [line.split(",", 1)[1] for line in (HEADER, row("a"), row("b"))]
        self.price(0, "\n".join([*lines[:2], empty[1:], lines[2]]), *FAST)
        self.assertEqual(["1", "2"], [reported["id"] for reported in self.prices()])

    def test_rejects_invalid_models(self):
        names = "id,spot,strike,rate,maturity,variance,model,intensity,jump_mean,jump_deviation,up_probability"
        lines = [names + ",up_rate,down_rate", "good,1,1,0.05,1,0.04,merton,0.1,-0.9,0.45,,,"]
        for k, (line, _) in enumerate(bad_batches.BAD_MODELS):
            lines.append(f"bad{k},1,1,0.05,1,0.04,{line}")
        self.price(3, "\n".join(lines), *FAST, "--tolerance", "1e-2")
        prices = self.prices()
        self.assertEqual("ok", prices[0]["status"])
        for reported, (line, words) in zip(prices[1:], bad_batches.BAD_MODELS, strict=True):
            with self.subTest(line):
                self.assertEqual("invalid", reported["status"])
                for word in words:
                    self.assertIn(word, reported["message"])

    def test_prices_extreme_numbers_without_false_results(self):
        """Finite extreme values are priced or reported; every price is finite and not negative."""
        values = [{name: text} for name in ("spot", "strike", "maturity", "variance", "alpha", "delta", "rate", "lambda")
                  for text in ("1e308", "4.9e-324", "1e-308")]
        lines = [row(k, **each) for k, each in enumerate(values)]
        for method in (("cos",), ("pide", "--mesh", "128", "--steps", "32")):
            with self.subTest(method):
                run = self.start("price", self.write(batch(lines)), "--backend", "serial", "--quiet", "--method", *method)
                self.assertIn(run.returncode, (0, 3, 4), run.stderr)
                for reported in self.prices():
                    self.assertIn(reported["status"], ("ok", "coarse", "invalid", "failed"))
                    if reported["price"]:
                        self.assertGreaterEqual(float(reported["price"]), 0.0)
                        self.assertLess(float(reported["price"]), float("inf"))

    def test_prices_scale_with_the_currency(self):
        """Price and Greeks are finite, and scale with the unit of money."""
        lines = [row(k, style="american", spot=1.1 * unit, strike=unit, type=kind)
                 for k, (unit, kind) in enumerate((unit, kind) for kind in ("put", "call") for unit in (1e-99, 1.0, 1e99))]
        for method in ((), FAST):
            self.expect(0, "price", self.write(batch(lines)), "--backend", "serial", "--quiet", "--greeks", *method)
            prices = self.prices()
            for reported, unit in zip(prices, (1e-99, 1.0, 1e99) * 2, strict=True):
                one = prices[1 if int(reported["id"]) < 3 else 4]
                for name, power in (("price", 1), ("error", 1), ("delta", 0), ("gamma", -1), ("theta", 1)):
                    self.assertAlmostEqual(1, float(reported[name]) / unit**power / float(one[name]), delta=1e-6, msg=name)

    def test_rejects_a_surface_with_an_extreme_strike(self):
        head, line = "id,spot,rate,lambda,alpha,beta,delta,variance", "a,1,0.05,1,8.15,-2.5,0.767,0.04"
        message = self.expect(3, "surface", self.write(f"{head}\n{line}\n"), "--strikes", "1,1e30", "--maturities", "1").stderr
        self.assertIn("batch.csv:2: spot/strike must lie between 1e-20 and 1e20 (1 of 2 prices invalid; all others", message)

    def test_rejects_a_strike_in_a_parameter_set(self):
        message = self.expect(3, "surface", self.write(batch([row("a")])), "--strikes", "1", "--maturities", "1").stderr
        self.assertIn('unknown column "strike"', message)
