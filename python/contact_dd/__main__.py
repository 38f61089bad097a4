"""`python -m contact_dd` is `contact-dd`."""

from contact_dd.command import main

main()
