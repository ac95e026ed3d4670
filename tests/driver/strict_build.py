"""What the build with run-time checks leaves to the release build."""
import os
import unittest

STRICT = os.environ.get('STRICT') == 'ON'
# Long tests whose lines of the program shorter ones reach too: run-time checks would see no more in them.
release_only = unittest.skipIf(STRICT, 'the release build runs it')
