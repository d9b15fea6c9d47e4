// Nothing of its own: this folder's precompiled headers need a source file to belong to.
