"""What a test of pictures needs."""
import shutil
import unittest

needs_gnuplot = unittest.skipIf(shutil.which('gnuplot') is None, 'gnuplot is not installed')
