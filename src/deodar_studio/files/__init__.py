"""Files below the root folder, the state folder of the user, and how documents are read from them."""
