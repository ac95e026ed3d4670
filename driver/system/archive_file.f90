!> A file of numbers from which a program can go on: written whole or not at all, and read only if
!> every bit of it is what was written. Who has something to keep lists its fields once, in a
!> procedure that visits them; the same visit writes or reads.
module archive_file
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use platform, only : rename_file
    implicit none
    private

    public :: archive, mix, mix_text

    !> In the file everything is a word of 64 bits; the last one is a checksum of those before.
    type :: archive
        logical :: writing = .false.          !! or else it is read
        logical, private :: failed = .false.
        integer, private :: unit = -1
        integer(int64), private :: checksum = 0
        integer(int64), private :: words = 0   !! written
        character(len=:), allocatable, private :: name
    contains
        procedure :: create, open, close
        procedure, private :: visit_fields, visit_reals, visit_table, visit_words
        generic :: visit => visit_fields, visit_reals, visit_table
        procedure :: visit_list
    end type archive

    integer, parameter :: word = 8   !! its bytes

contains

    !> Begins a new file. Until it is closed, the one that has the name stays.
    subroutine create(self, name, version)
        class(archive), intent(out) :: self
        character(len=*), intent(in) :: name
        integer(int64), intent(in) :: version   !! what a reader must ask for
        integer(int64) :: first
        integer :: status

        self%writing = .true.
        self%name = name
        open (newunit=self%unit, file=name // '.new', access='stream', form='unformatted', &
            status='replace', action='write', iostat=status)
        self%failed = status /= 0
        first = version
        call self%visit(first)
    end subroutine create

    !> Opens a file to read its fields in the order in which they were written.
    subroutine open(self, name, version, problem)
        class(archive), intent(out) :: self
        character(len=*), intent(in) :: name
        integer(int64), intent(in) :: version
        character(len=:), allocatable, intent(out) :: problem   !! why it cannot be used; or empty
        integer(int64) :: bytes, first
        integer :: status

        problem = ''
        self%name = name
        open (newunit=self%unit, file=name, access='stream', form='unformatted', status='old', &
            action='read', iostat=status)
        if (status /= 0) then
            problem = 'there is no checkpoint ' // name
            return
        end if
        inquire (unit=self%unit, size=bytes)
        call self%visit(first)
        if (self%failed .or. first /= version) then
            problem = name // ' is no checkpoint of this version'
        else if (.not. is_intact(self, bytes)) then
            problem = name // ' is damaged: its checksum is not that of its numbers'
        end if
        if (len(problem) > 0) close (self%unit)
    end subroutine open

    !> Reads the file once for its checksum, and goes back to the first field.
    logical function is_intact(self, bytes) result(intact)
        class(archive), intent(inout) :: self
        integer(int64), intent(in) :: bytes   !! length of the file
        integer, parameter :: part = 512   !! words that are read together
        integer(int64) :: chunk(part), left, found, checksum
        integer :: n, status

        left = bytes / word - 2   ! the version is read, the checksum comes last
        do while (left > 0)
            n = int(min(left, int(part, int64)))
            call self%visit_words(chunk(:n))
            left = left - n
        end do
        checksum = self%checksum
        read (self%unit, iostat=status) found
        intact = mod(bytes, int(word, int64)) == 0 .and. .not. self%failed .and. status == 0
        if (intact) intact = found == checksum
        if (intact) then
            read (self%unit, pos=word + 1, iostat=status)
            intact = status == 0
        end if
    end function is_intact

    !> Ends a file. One that was written takes its name now, if all of it has arrived.
    subroutine close(self, done)
        class(archive), intent(inout) :: self
        logical, intent(out) :: done
        integer(int64) :: bytes
        integer :: status

        status = 0
        if (self%writing .and. .not. self%failed) write (self%unit, iostat=status) self%checksum
        done = .not. self%failed .and. status == 0
        if (self%unit /= -1) close (self%unit)
        if (.not. self%writing .or. .not. done) return
        inquire (file=self%name // '.new', size=bytes)
        done = bytes == word * (self%words + 1)
        if (done) done = rename_file(self%name // '.new', self%name)
    end subroutine close

    subroutine visit_words(self, chunk)
        class(archive), intent(inout) :: self
        integer(int64), intent(inout) :: chunk(:)
        integer :: status

        if (self%failed) return
        if (self%writing) then
            write (self%unit, iostat=status) chunk
        else
            read (self%unit, iostat=status) chunk
        end if
        self%failed = status /= 0
        self%words = self%words + size(chunk)
        call mix(chunk, self%checksum)
    end subroutine visit_words

    !> Numbers and truth values, as many as fit in a line.
    subroutine visit_fields(self, a, b, c, d, e, f, g)
        class(archive), intent(inout) :: self
        class(*), intent(inout) :: a
        class(*), intent(inout), optional :: b, c, d, e, f, g

        call visit_field(self, a)
        if (present(b)) call visit_field(self, b)
        if (present(c)) call visit_field(self, c)
        if (present(d)) call visit_field(self, d)
        if (present(e)) call visit_field(self, e)
        if (present(f)) call visit_field(self, f)
        if (present(g)) call visit_field(self, g)
    end subroutine visit_fields

    subroutine visit_field(self, field)
        type(archive), intent(inout) :: self
        class(*), intent(inout) :: field
        integer(int64) :: chunk(1)

        select type (field)
        type is (real(dp))
            chunk = transfer(field, chunk)
            call self%visit_words(chunk)
            field = transfer(chunk(1), field)
        type is (integer)
            chunk = field
            call self%visit_words(chunk)
            field = int(chunk(1))
        type is (integer(int64))
            chunk = field
            call self%visit_words(chunk)
            field = chunk(1)
        type is (logical)
            chunk = merge(1, 0, field)
            call self%visit_words(chunk)
            field = chunk(1) /= 0
        end select
    end subroutine visit_field

    !> An array whose size the reader knows.
    subroutine visit_reals(self, numbers)
        class(archive), intent(inout) :: self
        real(dp), intent(inout) :: numbers(:)
        integer(int64) :: chunk(size(numbers))

        chunk = transfer(numbers, chunk)
        call self%visit_words(chunk)
        numbers = transfer(chunk, numbers)
    end subroutine visit_reals

    subroutine visit_table(self, numbers)
        class(archive), intent(inout) :: self
        real(dp), intent(inout) :: numbers(:, :)
        integer :: j

        do j = 1, size(numbers, 2)
            call self%visit(numbers(:, j))
        end do
    end subroutine visit_table

    !> A list that brings its size along.
    subroutine visit_list(self, numbers)
        class(archive), intent(inout) :: self
        real(dp), allocatable, intent(inout) :: numbers(:)
        integer :: n

        n = 0
        if (allocated(numbers)) n = size(numbers)
        call self%visit(n)
        if (self%failed) return
        if (.not. self%writing) numbers = spread(0.0_dp, 1, n)
        call self%visit(numbers)
    end subroutine visit_list

    !> Takes words into a checksum: another one for any single bit that differs.
    pure subroutine mix(chunk, mixed)
        integer(int64), intent(in) :: chunk(:)
        integer(int64), intent(inout) :: mixed
        integer :: i

        do i = 1, size(chunk)
            mixed = ieor(ishftc(mixed, 23), chunk(i))
            mixed = ieor(mixed, shiftl(mixed, 13))
            mixed = ieor(mixed, shiftr(mixed, 7))
        end do
    end subroutine mix

    !> Takes the letters of a text into it.
    pure subroutine mix_text(text, mixed)
        character(len=*), intent(in) :: text
        integer(int64), intent(inout) :: mixed
        integer :: i

        do i = 1, len(text)
            call mix([int(iachar(text(i:i)), int64)], mixed)
        end do
    end subroutine mix_text

end module archive_file
